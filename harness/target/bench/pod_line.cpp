#include "harness/target/bench/pod_line.hpp"

#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace whirl::bench {
namespace {

bool is_on_line(const BoardDevice& device) {
  return is_pod_host(device) && !can_of_host(device);
}

}  // namespace

PodLine::PodLine(PodLineOptions options)
    : SerialRackLink({options.link.name, options.link.path, "a pod's host"}, {.baud = io::kPodBaud},
                     options.seed, is_on_line, options.places),
      options_(std::move(options)) {}

Result<Done> PodLine::open() {
  const auto built = build(options_.board, options_.types, "its host's line");
  if (!built) return built;
  return open_line(io::TtyFrame::n81, io::kPodBaud);
}

Result<Done> PodLine::send_waiting(std::int64_t /*now_host_ns*/) {
  if (const auto written = tty_->write(waiting_); !written) return written;
  waiting_.clear();
  return tty_->flush();
}

std::vector<std::string> PodLine::findings() const {
  std::vector<std::string> all;
  add_pod_findings(all);
  return all;
}

}  // namespace whirl::bench
