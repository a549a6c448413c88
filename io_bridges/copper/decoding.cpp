#include "io_bridges/copper/decoding.hpp"

#include <algorithm>
#include <span>

namespace whirl::copper {

void Decoding::begin(const std::vector<std::string>& channels, double rate_Hz) {
  rate_Hz_ = rate_Hz;
  auto made = BusDecoders::make(channels, names_);
  if (!made) {
    error_ = made.error();
    return;
  }
  decoders_ = std::move(made.value());
  for (const std::string& channel : channels) {
    const auto name = channel_name(channel);
    if (!name || (name->role != Role::pin && name->role != Role::ready)) continue;
    const auto& among = name->role == Role::pin ? names_.pins : names_.devices;
    const auto found = std::find(among.begin(), among.end(), name->thing);
    (name->role == Role::pin ? pins_ : ready_)
        .insert(static_cast<std::uint16_t>(found - among.begin()));
  }
}

void Decoding::on_edge(const Edge& edge) {
  if (decoders_) decoders_->on_edge(edge, messages_);
}

void Decoding::advance_to(std::int64_t t_ns) {
  end_ns_ = t_ns;
  if (decoders_) decoders_->advance_to(t_ns, messages_);
}

// Each message is told as its frame ends, but a serial byte that ends without an edge.
io::Batch Decoding::in_order() const {
  struct Place {
    std::int64_t t_ns;
    io::Header header;
    std::span<const std::uint8_t> payload;
  };
  std::vector<Place> all;
  for (io::Reader r(messages_.bytes()); r.next();) {
    all.push_back({r.header().t_ns, r.header(), r.payload()});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Place& a, const Place& b) { return a.t_ns < b.t_ns; });
  io::Batch sorted;
  for (const Place& place : all) sorted.add(place.header, place.payload);
  return sorted;
}

std::vector<std::string> Decoding::buses() const {
  return decoders_ ? decoders_->buses() : std::vector<std::string>{};
}

const std::vector<std::int64_t>& Decoding::marker_rises_ns() const {
  static const std::vector<std::int64_t> kNone;
  return decoders_ ? decoders_->marker_rises_ns() : kNone;
}

}  // namespace whirl::copper
