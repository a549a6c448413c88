#include "base/interruption.hpp"

#include <atomic>
#include <csignal>

namespace whirl {
namespace {

std::atomic<int> came{0};
static_assert(std::atomic<int>::is_always_lock_free);  // the handler stores into it

}  // namespace

void catch_interruptions() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { came.store(signal); };
  action.sa_flags = SA_RESETHAND;  // the second one acts as ever
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  std::signal(SIGCHLD, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

int interrupted_by() {
  return came.load();
}

const char* signal_word(int signal) {
  switch (signal) {
    case SIGINT:
      return "INT";
    case SIGTERM:
      return "TERM";
    case SIGHUP:
      return "HUP";
    default:
      return "?";
  }
}

void pretend_interruption(int signal) {
  came.store(signal);
}

}  // namespace whirl
