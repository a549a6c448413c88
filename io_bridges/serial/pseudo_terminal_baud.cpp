// In a file of its own: the kernel's header has the free rate, and libc's termios.h declares the same names.
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::io {

// Asked at this end, the kernel answers for the other one.
double PseudoTerminal::baud() const {
  termios2 line{};
  ioctl(file_, TCGETS2, &line);
  return line.c_ospeed;
}

}  // namespace whirl::io
