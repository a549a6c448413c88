#include "io_bridges/qemu/tests/board_run.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "base/digest.hpp"
#include "io_bridges/board_description/board_text.hpp"

namespace whirl::board_test {

std::string image(const std::string& name) {
  return std::string(WHIRL_IMAGES "/") + name + ".elf";
}

VirtualBoardOptions options_for(const BoardSetup& setup) {
  std::string watch;
  for (const std::string& name : setup.watch) watch += (watch.empty() ? "\"" : ",\"") + name + "\"";
  // Most images here are counted by hand in instructions: 8 ns each, unless said.
  const bool timed = setup.more.find("ns_per_instruction") != std::string::npos;
  const std::string more = std::string(timed ? "" : R"(,"ns_per_instruction":8)") +
                           (setup.more.empty() ? "" : "," + setup.more);
  VirtualBoardOptions options;
  const std::string text = R"({"board":"bench","hse_Hz":8000000,"mcu":")" + setup.mcu +
                           R"(","image":")" + setup.image + R"(","gdb_port":)" +
                           std::to_string(setup.gdb_port) + R"(,"watch":[)" + watch + "]" + more +
                           "}";
  const auto start = read_board_text(text);
  EXPECT_TRUE(start) << text;
  if (start) options.board = start.value();
  options.silence_s = setup.silence_s;
  return options;
}

namespace {

void keep(BoardRun& run, Digest& digest, const io::Batch& batch) {
  digest.add_bytes(batch.bytes().data(), batch.bytes().size());
  run.keep(batch);
}

}  // namespace

BusyHost::BusyHost() {
  constexpr int kThreads = 3;
  threads_.reserve(kThreads);
  for (int i = 0; i < kThreads; ++i) {
    threads_.emplace_back([this] {
      while (!stop_.load(std::memory_order_relaxed)) {
      }
    });
  }
}

BusyHost::~BusyHost() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

BoardRun run_for(const BoardSetup& setup, int milliseconds) {
  VirtualBoard target(options_for(setup));
  BoardRun run;
  Digest digest;
  const auto started = target.start();
  if (!started) {
    run.error = started.error();
    return run;
  }
  io::Batch happened;
  for (int k = 1; k <= milliseconds && run.state == TargetState::running; ++k) {
    target.run(k * std::int64_t{1'000'000}, {});
    const auto state = target.arrive(happened);
    if (!state) {
      run.error = state.error();
      return run;
    }
    run.state = state.value();
    keep(run, digest, happened);
  }
  target.stop(happened);
  keep(run, digest, happened);
  run.digest = digest.hex();
  return run;
}

void BoardRun::keep(const io::Batch& batch) {
  for (io::Reader r(batch.bytes()); r.next();) {
    messages.push_back({r.header(), {r.payload().begin(), r.payload().end()}});
  }
}

std::vector<const Message*> BoardRun::of(io::Kind kind) const {
  std::vector<const Message*> found;
  for (const Message& message : messages) {
    if (message.head.kind == kind) found.push_back(&message);
  }
  return found;
}

std::string BoardRun::text_of(const Message& message, std::size_t head) const {
  if (message.payload.size() < head) return "";
  return {message.payload.begin() + static_cast<std::ptrdiff_t>(head), message.payload.end()};
}

bool BoardRun::found(const std::string& words) const {
  for (const Message* message : of(io::Kind::finding)) {
    if (text_of(*message).find(words) != std::string::npos) return true;
  }
  return false;
}

std::vector<std::uint32_t> BoardRun::said() const {
  std::vector<std::uint32_t> values;
  for (const Message* message : of(io::Kind::finding)) {
    const std::string text = text_of(*message);
    const std::size_t at = text.find("says 0x");
    if (at == std::string::npos) continue;
    values.push_back(static_cast<std::uint32_t>(std::strtoul(text.c_str() + at + 5, nullptr, 16)));
  }
  return values;
}

std::vector<std::uint32_t> BoardRun::numbers() const {
  std::string text;
  for (const Message* message : of(io::Kind::uart_received)) text += text_of(*message);
  std::istringstream lines(text.substr(0, text.rfind('\n')));
  std::vector<std::uint32_t> values;
  for (std::uint32_t value = 0; lines >> value;) values.push_back(value);
  return values;
}

}  // namespace whirl::board_test
