// A logic analyser's clips as the bench's log of its buses.
//
//   Tells     i2c_transaction, spi_transaction, data_ready and pin_edge, once the run has ended: they are judged then,
//             and only then are the clocks known
//   Clocks    a marker pulse when the run begins and one when it ends, by a serial line's RTS on a clip of its own; the
//             host's moments before and after each bound its time. Offset and rate are fitted, the residue is told
//   Unread    without both pulses, or with other pulses than were sent, every bus counts as unread from begin to end:
//             what a window asks of it is not shown
//   Errors    as the analyser's (io_bridges/sigrok); host: it stopped by itself, or lost samples
#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/link.hpp"
#include "io_bridges/copper/clock_fit.hpp"
#include "io_bridges/copper/decoding.hpp"

namespace whirl::bench {

// A device, or what tests have in its place.
class EdgeSource {
 public:
  virtual ~EdgeSource() = default;
  virtual Result<Done> open() = 0;
  // Returns after stop(), called from another thread. Errors  host: it ended by itself
  virtual Result<Done> run(copper::EdgeSink& sink) = 0;
  virtual void stop() = 0;
  virtual std::string version() const = 0;
};

class MarkerLine {
 public:
  virtual ~MarkerLine() = default;
  virtual Result<Done> open() = 0;
  // The line rises between the two moments of the host that are given back, and falls again later.
  virtual Result<std::pair<std::int64_t, std::int64_t>> pulse() = 0;
};

std::unique_ptr<EdgeSource> sigrok_source(const AnalyserClips& clips);
std::unique_ptr<MarkerLine> rts_marker(const std::string& path);

class AnalyserLink final : public Link {
 public:
  AnalyserLink(std::string name, std::unique_ptr<EdgeSource> source,
               std::unique_ptr<MarkerLine> marker, copper::BoardNames names);
  ~AnalyserLink() override;

  std::string name() const override { return name_; }
  Result<Done> open() override;
  bool take(const io::Reader&, std::int64_t) override { return false; }
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  void finish(const VirtualTime& virtual_ns, std::int64_t end_ns, io::Batch& happened) override;
  void close() override;
  std::vector<std::pair<std::string, std::string>> versions() const override;

 private:
  class Locked;  // the decoding, shared with the source's thread
  Result<Done> mark();
  void tell_all(const copper::ClockFit& fit, const VirtualTime& virtual_ns, std::int64_t end_ns,
                io::Batch& happened) const;
  void tell_unread(const std::string& why, std::int64_t end_ns, io::Batch& happened) const;

  std::string name_;
  std::unique_ptr<EdgeSource> source_;
  std::unique_ptr<MarkerLine> marker_;
  std::unique_ptr<Locked> seen_;
  std::thread thread_;
  std::vector<std::pair<std::int64_t, std::int64_t>> asked_ns_;  // of each pulse, the host's
};

}  // namespace whirl::bench
