// What one exchange between two processes costs: prints microseconds per round trip.
//   link_cost [ROUNDS] [BYTES]
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <tuple>
#include <vector>

#include "io_bridges/link/channel.hpp"

namespace {

using whirl::io::Channel;
using whirl::io::Side;

int echo(int fd, long rounds) {
  auto link = Channel::attach(Side::board, fd);
  if (!link) return 1;
  for (long k = 0; k < rounds; ++k) {
    if (!link.value().wait(10000)) return 2;
    std::ignore = link.value().post(k, link.value().received().bytes);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const long rounds = argc > 1 ? std::atol(argv[1]) : 100000;
  const std::vector<std::uint8_t> bytes(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 500);
  auto link = Channel::create(Side::harness);
  if (!link) return 1;
  const pid_t child = fork();
  if (child == 0) _exit(echo(dup(link.value().fd()), rounds));
  const auto from = std::chrono::steady_clock::now();
  for (long k = 0; k < rounds; ++k) {
    if (!link.value().post(k, bytes) || !link.value().wait(10000)) return 1;
  }
  const std::chrono::duration<double> host = std::chrono::steady_clock::now() - from;
  waitpid(child, nullptr, 0);
  std::printf("%.2f us per exchange of %zu bytes each way, %ld exchanges\n",
              host.count() * 1e6 / static_cast<double>(rounds), bytes.size(), rounds);
  return 0;
}
