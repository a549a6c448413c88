#include "harness/timing/capture.hpp"

namespace whirl::timing {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000, kLongest_ns = 60'000'000'000;

bool ended(const std::string& text) {
  const std::size_t last = text.rfind("\nend ");
  return last != std::string::npos && text.find('\n', last + 1) != std::string::npos;
}

}  // namespace

Result<std::string> capture(Target& target, std::uint16_t port) {
  if (auto started = target.start(); !started) return started.error();
  std::string text;
  io::Batch happened;
  const io::Batch nothing;
  TargetState state = TargetState::running;
  for (std::int64_t t_ns = kStep_ns;
       t_ns <= kLongest_ns && state == TargetState::running && !ended(text); t_ns += kStep_ns) {
    target.run(t_ns, nothing);
    const auto arrived = target.arrive(happened);
    if (!arrived) return arrived.error();
    state = arrived.value();
    for (io::Reader reader(happened.bytes()); reader.next();) {
      const io::Header& header = reader.header();
      if (header.kind != io::Kind::uart_received || header.port != port) continue;
      text.append(reader.payload().begin(), reader.payload().end());
    }
  }
  target.stop(happened);
  return text;
}

}  // namespace whirl::timing
