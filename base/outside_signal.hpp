// Of a process of ours that a signal has ended: was it somebody else's doing, and no bug?
#pragma once
#include <csignal>

namespace whirl {

inline bool is_from_outside(int signal) {
  switch (signal) {
    case SIGKILL:  // a user, or the kernel for want of memory
    case SIGTERM:  // a user, a service manager, a shutdown
    case SIGINT:   // a terminal's interrupt,
    case SIGQUIT:  // its quit,
    case SIGHUP:   // or its end
    case SIGUSR1:  // nobody here sends these two
    case SIGUSR2:
    case SIGXCPU:  // the limit of CPU time
    case SIGXFSZ:  // the limit of a file's size
    case SIGBUS:   // shared memory that its full file system could not give
      return true;
    default:
      return false;
  }
}

}  // namespace whirl
