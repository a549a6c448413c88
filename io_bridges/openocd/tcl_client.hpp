// A client of openocd's Tcl server: a command out, its answer back, each closed by the byte 0x1A.
//
//   Source   OpenOCD user's guide, "Tcl RPC server"
//   Wraps    each command in `catch`, so that an answer says whether it is one or a complaint
//   Errors   host: nobody answers, or not in time; bad_input: openocd could not do it, in its own words
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hpp"

namespace whirl::openocd {

class TclClient {
 public:
  static Result<std::unique_ptr<TclClient>> connect(std::uint16_t port, int timeout_ms = 5000);
  ~TclClient();
  TclClient(const TclClient&) = delete;
  TclClient& operator=(const TclClient&) = delete;

  // One line of Tcl. Flashing takes its time: other commands need not wait so long.
  Result<std::string> ask(const std::string& command, int timeout_ms = 5000);

 private:
  explicit TclClient(int socket) : socket_(socket) {}
  Result<std::string> exchange(const std::string& line, int timeout_ms);

  int socket_;
};

}  // namespace whirl::openocd
