#include "harness/target/bench/rack_link.hpp"

#include <algorithm>
#include <tuple>

namespace whirl::bench {
namespace {

constexpr std::int64_t kGrain_ns = 50'000;  // of the host: not a turn for each event

}  // namespace

RackLink::RackLink(rack::FarRack& rack, const std::optional<PodPlaces>& pod) : rack_(rack) {
  if (!pod) return;
  pod_.emplace(rack);
  places_ = *pod;
}

Result<Done> RackLink::build(const BoardDescription& board, const rack::DeviceTypes& types,
                             const std::string& wire) {
  if (const auto built = rack_.build(board, types); !built) return built;
  if (rack_.devices() > 0) return Done{};
  return Error{ErrorKind::bad_input, board.name, "has no device on " + wire + " to be played", ""};
}

bool RackLink::take(const io::Reader& order, std::int64_t /*due_host_ns*/) {
  if (pod_ && order.header().kind == io::Kind::fault) {
    give_fault(order);
  } else if (!pod_ || PodCounts::is_for_host(order)) {
    rack_.on_message(order);
  }
  return false;
}

void RackLink::give_fault(const io::Reader& order) {
  auto fault = order.as<io::FaultCommand>();
  const auto part = places_.find({fault.bus, fault.address});
  if (part == places_.end()) return;
  std::tie(fault.bus, fault.address) = part->second;
  io::Batch given;
  given.add(io::Kind::fault, order.header().port, order.header().t_ns, fault);
  io::Reader reader(given.bytes());
  if (reader.next()) rack_.on_message(reader);
}

void RackLink::advance(std::int64_t host_ns) {
  io::EventQueue& events = rack_.events();
  events.run_until(std::max(events.now(), time_.virtual_ns(host_ns)));
}

Result<Done> RackLink::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  served_host_ns_ = now_host_ns;
  if (const auto taken = take_in(now_host_ns); !taken) return taken;
  advance(now_host_ns);
  if (pod_) pod_->turn();
  if (const auto sent = send_waiting(now_host_ns); !sent) return sent;
  hand_over(arrivals);
  return Done{};
}

void RackLink::hand_over(Arrivals& arrivals) {
  for (io::Reader r(rack_.happened().bytes()); r.next();) {
    if (pod_ && pod_->hears(r)) continue;
    const io::Header& head = r.header();
    arrivals.push_back({time_.due_host_ns(head.t_ns),
                        head.kind,
                        head.port,
                        {r.payload().begin(), r.payload().end()}});
  }
  rack_.happened().clear();
}

void RackLink::finish(const VirtualTime& /*virtual_ns*/, std::int64_t /*end_ns*/,
                      io::Batch& /*happened*/) {
  if (pod_) pod_->finish();
}

void RackLink::add_pod_findings(std::vector<std::string>& findings) const {
  if (!pod_) return;
  for (const std::string& finding : pod_->findings()) findings.push_back(finding);
}

std::int64_t RackLink::next_due_host_ns() const {
  const std::int64_t deadline_ns = rack_.events().next_deadline();
  if (deadline_ns == io::kNever) return kNever_ns;
  return std::max(time_.due_host_ns(deadline_ns), served_host_ns_ + kGrain_ns);
}

}  // namespace whirl::bench
