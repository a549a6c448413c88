// A developer's tool: runs one image on the bench part (or a board description) for some virtual
// time, prints its messages' digest, its findings and what an exchange and a millisecond cost.
//   run_board IMAGE SECONDS [MCU] [QEMU OPTIONS...]
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "base/digest.hpp"
#include "harness/target/virtual_board.hpp"

namespace {

void show(const whirl::io::Batch& batch) {
  for (whirl::io::Reader r(batch.bytes()); r.next();) {
    const auto text = r.payload();
    if (std::getenv("KINDS"))
      std::printf("%12lld kind %d port %d size %u\n", static_cast<long long>(r.header().t_ns),
                  static_cast<int>(r.header().kind), r.header().port, r.header().size);
    if (r.header().kind == whirl::io::Kind::finding ||
        r.header().kind == whirl::io::Kind::statistics) {
      std::printf("%12lld ns  %.*s\n", static_cast<long long>(r.header().t_ns),
                  static_cast<int>(text.size()), reinterpret_cast<const char*>(text.data()));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  whirl::VirtualBoardOptions options;
  const std::string mcu = argc > 3 ? argv[3] : "bench_m4";
  options.board.board = {.name = "bench", .mcu = mcu, .hse_Hz = 8e6};
  options.board.run.image = argv[1];
  if (const char* port = std::getenv("GDB_PORT")) options.board.run.gdb_port = std::atoi(port);
  for (int i = 4; i < argc; ++i) options.qemu_options.emplace_back(argv[i]);
  whirl::VirtualBoard target(options);
  const auto started = target.start();
  if (!started) {
    std::printf("start: %s\n", started.error().message().c_str());
    return 1;
  }
  const auto from = std::chrono::steady_clock::now();
  whirl::Digest digest;
  whirl::io::Batch happened;
  const long steps = std::atol(argv[2]) * 1000;
  for (long k = 1; k <= steps; ++k) {
    target.run(k * 1'000'000, {});
    const auto state = target.arrive(happened);
    digest.add_bytes(happened.bytes().data(), happened.bytes().size());
    show(happened);
    if (!state) {
      std::printf("%s\n", state.error().message().c_str());
      return 1;
    }
    if (state.value() != whirl::TargetState::running) break;
  }
  const std::chrono::duration<double> host = std::chrono::steady_clock::now() - from;
  target.stop(happened);
  show(happened);
  std::printf("digest %s, %.2f us per virtual ms, %.2f times real time\n%s", digest.hex().c_str(),
              host.count() * 1e6 / static_cast<double>(steps),
              static_cast<double>(steps) * 1e-3 / host.count(), target.output().c_str());
  return 0;
}
