#include "harness/target/node_set.hpp"

#include <optional>

#include "base/check.hpp"

namespace whirl {

NodeSet::NodeSet(std::vector<Entry> nodes, std::vector<UartWire> wires)
    : nodes_(std::move(nodes)), wires_(std::move(wires)), inbox_(nodes_.size()) {
  WHIRL_CHECK(!nodes_.empty() && nodes_.size() <= 256, nodes_.size());
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
    if (arrived && state == TargetState::running) state = arrived.value();
    if (arrived || first) continue;
    first = arrived.error();
    first->place = nodes_[i].name + ": " + first->place;
  }
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
