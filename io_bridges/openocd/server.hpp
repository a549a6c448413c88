// openocd as a child process, for as long as a probe is used.
//
//   Start    with the bench's configuration, no ports but the Tcl one on the loopback; ready when it answers
//   Errors   bad_input, one line with its cure, from what openocd complained of: not installed, no probe, no
//            permission, busy, no target behind the probe, a configuration that it does not know
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/openocd/tcl_client.hpp"

namespace whirl::openocd {

struct ServerOptions {
  std::string program = "openocd";
  std::vector<std::string> files = {};  // -f: "interface/stlink.cfg", "target/stm32f4x.cfg"
  std::vector<std::string> commands =
      {};  // -c, before init: "adapter serial ...", "adapter speed 4000"
  int start_timeout_ms = 10'000;
};

class Server {
 public:
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  TclClient& client() { return *client_; }

 private:
  Server() = default;
  pid_t pid_ = -1;
  std::unique_ptr<TclClient> client_;
};

// What openocd's complaints mean, in one line. `said`: all that it wrote.
Error complaint_of(const std::string& said);

}  // namespace whirl::openocd
