// The register fuzzer as a program: fuzz_registers [SEEDS [FIRST]]. Exit 0: nothing found.
//
//   Found    too many events, a failed check, a crash, or more than 30 s of processor time for one
//            seed, which is named. After a crash or a hang it ends; else it goes on
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/check.hpp"
#include "io_bridges/qemu/stm32/fuzz/register_fuzz.hpp"

namespace {

constexpr int kHang_s = 30;
std::uint64_t seed = 0;  // the one that runs

void on_signal(int signal) {
  char text[80];
  const int size =
      std::snprintf(text, sizeof text, "seed %" PRIu64 ": %s\n", seed, strsignal(signal));
  if (write(STDOUT_FILENO, text, static_cast<std::size_t>(size)) != size) _exit(2);
  _exit(1);
}

std::string complaint_of(whirl::stm32::FuzzOutcome& total) {
  const itimerval limit{{0, 0}, {kHang_s, 0}};
  setitimer(ITIMER_VIRTUAL, &limit, nullptr);
  try {
    const auto outcome = whirl::stm32::fuzz_registers(seed);
    total.accesses += outcome.accesses;
    total.events += outcome.events;
    return outcome.complaint;
  } catch (const std::exception& exception) {
    return exception.what();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
  whirl::base::set_check_handler(whirl::base::throw_check_failure);
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGVTALRM}) {
    signal(number, on_signal);
  }
  whirl::stm32::FuzzOutcome total;
  std::uint64_t bad = 0;
  for (seed = first; seed < first + count; ++seed) {
    const std::string complaint = complaint_of(total);
    if (complaint.empty()) continue;
    ++bad;
    std::printf("seed %" PRIu64 ": %s\n", seed, complaint.c_str());
  }
  std::printf("%" PRIu64 " programs, %" PRIu64 " accesses, %" PRIu64 " events, %" PRIu64 " bad\n",
              count, total.accesses, total.events, bad);
  return bad == 0 ? 0 : 1;
}
