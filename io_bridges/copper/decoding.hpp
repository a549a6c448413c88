// A whole capture through the decoders: an EdgeSink that keeps every message, with the names of what it saw.
#pragma once
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io_bridges/copper/bus_decoders.hpp"
#include "io_bridges/copper/edge_sink.hpp"

namespace whirl::copper {

class Decoding final : public EdgeSink {
 public:
  explicit Decoding(BoardNames names) : names_(std::move(names)) {}

  void begin(const std::vector<std::string>& channels, double rate_Hz) override;
  void on_edge(const Edge& edge) override;
  void advance_to(std::int64_t t_ns) override;

  // What the channels' names say cannot be; nothing was decoded then.
  const std::optional<Error>& error() const { return error_; }
  io::Batch in_order() const;  // by their times; what was decoded so far
  std::vector<std::string> buses() const;
  const std::set<std::uint16_t>& pins() const { return pins_; }
  const std::set<std::uint16_t>& ready() const { return ready_; }  // devices
  const std::vector<std::int64_t>& marker_rises_ns() const;
  double rate_Hz() const { return rate_Hz_; }
  std::int64_t end_ns() const { return end_ns_; }

 private:
  BoardNames names_;
  std::unique_ptr<BusDecoders> decoders_;
  std::optional<Error> error_;
  io::Batch messages_;
  std::set<std::uint16_t> pins_, ready_;
  double rate_Hz_ = 0.0;
  std::int64_t end_ns_ = 0;
};

}  // namespace whirl::copper
