#include "harness/standin/stand_in.hpp"

#include <array>
#include <cstdio>

#include "base/check.hpp"
#include "io_bridges/messages/can_message.hpp"

namespace whirl {

StandIn::StandIn(World& world, Target& board, pacing::HostClock& clock, StandInOptions options)
    : lockstep_(world, board),
      clock_(clock),
      pacer_(clock, options.pace),
      options_(std::move(options)) {
  const SignalTable signals(world.signals());
  for (const std::string& name : options_.told) {
    const auto column = signals.find(name);
    WHIRL_CHECK(column, name);
    columns_.push_back(*column);
  }
}

Result<Done> StandIn::run() {
  std::optional<Error> error;
  if (const auto started = lockstep_.start(); !started) error = started.error();
  while (!error) {
    pacer_.wait_for(lockstep_.now_ns());
    tell();
    {
      const std::scoped_lock lock(mutex_);
      if (ending_) break;
    }
    take_in();
    if (const auto taken = take_in_can(lockstep_.now_ns()); !taken) {
      error = taken.error();
      break;
    }
    const auto state = lockstep_.step();
    hand_out();
    if (!state) error = state.error();
    if (!state || state.value() != TargetState::running) break;
  }
  lockstep_.stop();
  const std::scoped_lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
  if (error) return *error;
  return Done{};
}

void StandIn::end() {
  const std::scoped_lock lock(mutex_);
  ending_ = true;
}

void StandIn::heard() {
  if (!heard_) pacer_.count_anew();
  heard_ = true;
}

// What came to the wires since the last step is in this one.
void StandIn::take_in() {
  const std::int64_t now_ns = lockstep_.now_ns();
  std::array<std::uint8_t, 1024> bytes;
  for (StandInLine& line : options_.lines) {
    const std::size_t size = line.end.read(bytes);
    if (size == 0) continue;
    heard();
    const io::Header head{now_ns, io::Kind::uart_frame, line.board, line.uart, 0};
    lockstep_.to_send().add(head, {std::span(bytes).first(size)});
  }
  const std::scoped_lock lock(mutex_);
  for (const std::uint32_t number : fresh_) {
    heard();
    const bench::Transfer& transfer = open_.at(number).transfer;
    const io::I2cOrder order{transfer.address, transfer.read, number};
    lockstep_.to_send().add(io::Kind::i2c_order, options_.i2c, now_ns, order, transfer.write.data(),
                            static_cast<std::uint32_t>(transfer.write.size()));
  }
  fresh_.clear();
}

void StandIn::hand_out() {
  for (io::Reader r(lockstep_.happened().bytes()); r.next();) {
    const io::Header& head = r.header();
    if (head.kind == io::Kind::i2c_reply) answer(r);
    if (head.kind == io::Kind::can_transfer && head.board == options_.can_board) hand_out_can(r);
    if (head.kind != io::Kind::uart_received) continue;
    for (StandInLine& line : options_.lines) {
      if (line.board == head.board && line.uart == head.port) line.end.write(r.payload());
    }
  }
}

// Of the interface: frames in, for this step, and what could not go out before.
Result<Done> StandIn::take_in_can(std::int64_t now_ns) {
  if (!options_.can) return Done{};
  for (; !to_can_.empty(); to_can_.pop_front()) {
    const auto sent = options_.can->send(to_can_.front());
    if (!sent) return sent.error();
    if (!sent.value()) break;
  }
  for (;;) {
    const auto got = options_.can->receive();
    if (!got) return got.error();
    if (!got.value()) return Done{};
    if (got.value()->own || got.value()->trouble) continue;
    heard();
    const io::CanMessage frame = io::to_message(got.value()->frame);
    const io::Header head{now_ns, io::Kind::can_order, options_.can_board, options_.can_bus, 0};
    lockstep_.to_send().add(head, {{reinterpret_cast<const std::uint8_t*>(&frame), sizeof frame}});
  }
}

void StandIn::hand_out_can(const io::Reader& passed) {
  const auto record = passed.as<io::CanRecord>();
  const bool of_the_board = record.sender == -1 && record.error == 0;
  if (!options_.can || !of_the_board || passed.header().port != options_.can_bus) return;
  to_can_.push_back(io::frame_of(record.frame));
}

void StandIn::answer(const io::Reader& reply) {
  const auto head = reply.as<io::I2cReplyHead>();
  const auto bytes = reply.tail_after(sizeof head);
  const std::scoped_lock lock(mutex_);
  const auto it = open_.find(head.number);
  if (it == open_.end()) return;
  bench::TransferOutcome outcome;
  outcome.acked = head.acked != 0;
  outcome.timed_out = head.timed_out != 0;
  outcome.bytes.assign(bytes.begin(), bytes.end());
  outcome.end_host_ns = clock_.now_ns();
  it->second.outcome = std::move(outcome);
  changed_.notify_all();
}

// When it is due: who reads the line takes the time at which it comes for that of the measurement.
void StandIn::tell() {
  if (!options_.instruments || lockstep_.now_ns() % options_.told_every_ns != 0) return;
  std::string line;
  for (const std::size_t column : columns_) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.7g", line.empty() ? "" : " ",
                  lockstep_.row()[column]);
    line += number;
  }
  line += "\r\n";
  options_.instruments->write({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

Result<bench::TransferOutcome> StandIn::transfer(const bench::Transfer& transfer) {
  const std::uint32_t number = begin(transfer);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || open_.at(number).outcome.has_value(); });
  auto outcome = std::move(open_.at(number).outcome);
  open_.erase(number);
  if (outcome) return std::move(*outcome);
  return Error{ErrorKind::host, "stand-in", "the board has ended", ""};
}

std::uint32_t StandIn::begin(const bench::Transfer& transfer) {
  const std::scoped_lock lock(mutex_);
  const std::uint32_t number = number_++;
  open_[number] = {transfer, std::nullopt};
  fresh_.push_back(number);
  return number;
}

std::optional<bench::TransferOutcome> StandIn::outcome(std::uint32_t number) {
  const std::scoped_lock lock(mutex_);
  const auto it = open_.find(number);
  if (it == open_.end() || (!it->second.outcome && !ended_)) return std::nullopt;
  bench::TransferOutcome outcome;  // of a board that has ended: nobody answered
  if (it->second.outcome) outcome = std::move(*it->second.outcome);
  open_.erase(it);
  return outcome;
}

}  // namespace whirl
