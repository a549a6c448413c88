#include "harness/target/node_set.hpp"

#include <optional>

#include "base/check.hpp"

namespace whirl {

namespace {

// How much the end of one target says of the run.
int weight(TargetState state) {
  switch (state) {
    case TargetState::cpu_locked:
      return 3;
    case TargetState::over_limit:
      return 2;
    case TargetState::ended:
      return 1;
    case TargetState::running:
      return 0;
  }
  return 0;
}

}  // namespace

NodeSet::NodeSet(std::vector<Entry> nodes, std::vector<UartWire> wires,
                 std::vector<BoardWireLink> board_wires)
    : nodes_(std::move(nodes)),
      wires_(std::move(wires)),
      board_wires_(std::move(board_wires)),
      arrived_(nodes_.size(), false),
      inbox_(nodes_.size()) {
  WHIRL_CHECK(!nodes_.empty() && nodes_.size() <= 256, nodes_.size());
  if (board_wires_.empty()) return;  // none waits for another
  for (Entry& node : nodes_) {
    node.target->set_company([this](bool silent) { return look_after(silent); });
  }
}

Error NodeSet::blame(std::size_t node, Error error) {
  error.place = nodes_[node].name + ": " + error.place;
  close_wires();
  blamed_ = error;
  return error;
}

// Asked while one of them is waited for.
std::optional<Error> NodeSet::look_after(bool silent) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (arrived_[i]) continue;
    Target& target = *nodes_[i].target;
    if (const auto error = target.died()) return blame(i, *error);
    if (target.over()) close_wires();  // whoever waits for it waits for nothing
    if (!silent || waits_for_another(i)) continue;
    if (const auto error = target.hangs()) return blame(i, *error);
  }
  return {};
}

bool NodeSet::waits_for_another(std::size_t node) const {
  for (const BoardWireLink& link : board_wires_) {
    if (link.leader == node && link.wire.leader_waits()) return true;
    if (link.follower == node && link.wire.follower_waits()) return true;
  }
  return false;
}

void NodeSet::close_wires() {
  for (BoardWireLink& link : board_wires_) link.wire.close();
}

Result<Done> NodeSet::start() {
  for (Entry& node : nodes_) {
    if (auto started = node.target->start(); !started) {
      Error error = started.error();
      error.place = node.name + ": " + error.place;
      return error;
    }
  }
  return Done{};
}

void NodeSet::run(std::int64_t until_ns, const io::Batch& sensed) {
  until_ns_ = until_ns;
  arrived_.assign(nodes_.size(), false);
  std::vector<io::Batch> own(nodes_.size());
  for (io::Reader r(sensed.bytes()); r.next();) {
    io::Header header = r.header();
    WHIRL_CHECK(header.board < nodes_.size(), header.board, nodes_.size());
    io::Batch& batch = own[header.board];
    header.board = 0;
    batch.add(header, r.payload());
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    io::add_for_board(inbox_[i], 0, own[i]);
    inbox_[i].clear();
    nodes_[i].target->run(until_ns, own[i]);
  }
}

Result<TargetState> NodeSet::arrive(io::Batch& happened) {
  now_ns_ = until_ns_;
  TargetState state = TargetState::running;
  std::optional<Error> first;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    io::Batch own;
    const auto arrived = nodes_[i].target->arrive(own);
    io::add_for_board(own, static_cast<std::uint8_t>(i), happened);
    carry(i, own);
    arrived_[i] = true;
    if (arrived && weight(arrived.value()) > weight(state)) state = arrived.value();
    if (!arrived || arrived.value() != TargetState::running) close_wires();
    if (arrived || first) continue;
    first = arrived.error();
    first->place = nodes_[i].name + ": " + first->place;
  }
  if (blamed_) return *blamed_;
  if (first) return *first;
  return state;
}

void NodeSet::carry(std::size_t from, const io::Batch& happened) {
  for (io::Reader r(happened.bytes()); r.next();) {
    if (r.header().kind != io::Kind::uart_received) continue;
    for (const UartWire& wire : wires_) {
      for (const auto& [source, sink] : {std::pair{wire.a, wire.b}, std::pair{wire.b, wire.a}}) {
        if (source.node != from || source.uart != r.header().port) continue;
        inbox_[sink.node].add(io::Kind::uart_frame, sink.uart, now_ns_, r.payload().data(),
                              static_cast<std::uint32_t>(r.payload().size()));
      }
    }
  }
}

void NodeSet::stop(io::Batch& happened) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    io::Batch own;
    nodes_[i].target->stop(own);
    io::add_for_board(own, static_cast<std::uint8_t>(i), happened);
  }
}

Offers NodeSet::offers() const {
  Offers all = kAll_offers;
  for (const Entry& node : nodes_) all = all & node.target->offers();
  return all;
}

std::vector<std::pair<std::string, std::string>> NodeSet::versions() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Entry& node : nodes_) {
    for (const auto& [what, version] : node.target->versions()) {
      all.emplace_back(node.name + "/" + what, version);
    }
  }
  return all;
}

}  // namespace whirl
