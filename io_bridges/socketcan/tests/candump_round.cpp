// For tools.sh: candump_round INTERFACE LOG COUNT: receives COUNT frames, answers each with its identifier plus one and
// the same bytes, and leaves all of them as a log.
#include <poll.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "io_bridges/socketcan/candump_log.hpp"
#include "io_bridges/socketcan/socket_can.hpp"

int main(int argc, char** argv) {
  using namespace whirl::io;
  if (argc != 4) return 2;
  auto opened = SocketCan::open(argv[1], 0);
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message().c_str());
    return 2;
  }
  SocketCan port = std::move(opened.value());
  std::ofstream log(argv[2]);
  std::printf("ready\n");
  std::fflush(stdout);
  for (int left = std::atoi(argv[3]); left > 0;) {
    pollfd file{port.file(), POLLIN, 0};
    if (poll(&file, 1, 10'000) != 1) return 1;
    const auto got = port.receive();
    if (!got) return 1;
    if (!got.value() || got.value()->trouble || got.value()->own) continue;
    CanFrame frame = got.value()->frame;
    log << candump_line(got.value()->host_ns, argv[1], frame) << "\n";
    ++frame.id;
    if (!port.send(frame).value()) return 1;
    log << candump_line(got.value()->host_ns, argv[1], frame) << "\n";
    --left;
  }
  return 0;
}
