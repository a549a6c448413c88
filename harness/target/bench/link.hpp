// What joins one bus of a physical board to this host.
//
//   Turn    serve() does what is due and takes what has come, and never waits; between turns the bench's loop
//           sleeps until `file` can be read, or the next order is due
//   Times   of the host's monotonic clock; the loop makes virtual time of them
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::bench {

inline constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

struct Arrival {  // a message as a link has it
  std::int64_t host_ns = 0;
  io::Kind kind{};
  std::uint16_t port = 0;
  std::vector<std::uint8_t> payload;
};
using Arrivals = std::vector<Arrival>;

// The virtual time of one of the host's.
using VirtualTime = std::function<std::int64_t(std::int64_t host_ns)>;

// For a link that lives in virtual time itself.
struct BenchTime {
  VirtualTime virtual_ns;                                      // never beyond the step at hand
  std::function<std::int64_t(std::int64_t t_ns)> due_host_ns;  // when a virtual time is due
};

class Link {
 public:
  virtual ~Link() = default;

  virtual std::string name() const = 0;
  // Errors  bad_input: what the bench file names is not there, or not what it says; with place and cure
  virtual Result<Done> open() = 0;
  // Once, before the first order.
  virtual void keep_time(BenchTime /*time*/) {}
  // True: it is this link's, and will go out at that time of the host.
  virtual bool take(const io::Reader& order, std::int64_t due_host_ns) = 0;
  // Errors  host: it was unplugged, or nobody takes what is written
  virtual Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) = 0;
  virtual std::int64_t next_due_host_ns() const { return kNever_ns; }
  virtual int file() const { return -1; }  // to poll for reading; -1: none
  // At once: what waits is dropped, the zero set-point goes out, and nothing but that from now on.
  virtual void make_safe() {}
  // It heard nothing of the loop for too long, and has made safe by itself.
  virtual bool heartbeat_lost() const { return false; }
  // The run is over at that virtual time: what only then can be told. Before close().
  virtual void finish(const VirtualTime& /*virtual_ns*/, std::int64_t /*end_ns*/,
                      io::Batch& /*happened*/) {}
  virtual void close() = 0;
  virtual std::vector<std::pair<std::string, std::string>> versions() const { return {}; }
  // What went wrong at it, for who reads the run. Pre: closed.
  virtual std::vector<std::string> findings() const { return {}; }
};

}  // namespace whirl::bench
