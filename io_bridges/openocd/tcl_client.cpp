#include "io_bridges/openocd/tcl_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace whirl::openocd {
namespace {

constexpr char kEnd = '\x1a';
constexpr std::size_t kMost_B = 1 << 20;  // of an answer

Error broken(const std::string& what) {
  return {ErrorKind::host, "openocd", what, ""};
}

}  // namespace

Result<std::unique_ptr<TclClient>> TclClient::connect(std::uint16_t port, int timeout_ms) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return broken("no socket");
  std::unique_ptr<TclClient> client(new TclClient(socket));
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(port);
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0) {
    return broken("nobody listens at port " + std::to_string(port) + ": " + std::strerror(errno));
  }
  const auto alive = client->ask("version", timeout_ms);
  if (!alive) return alive.error();
  return client;
}

TclClient::~TclClient() {
  ::close(socket_);
}

Result<std::string> TclClient::exchange(const std::string& line, int timeout_ms) {
  const std::string out = line + kEnd;
  for (std::size_t sent = 0; sent < out.size();) {
    const ssize_t n = ::send(socket_, out.data() + sent, out.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return broken(std::string("does not listen any more: ") + std::strerror(errno));
    sent += static_cast<std::size_t>(n);
  }
  std::string answer;
  while (answer.size() < kMost_B) {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, timeout_ms) != 1) {
      return broken("gave no answer to '" + line.substr(0, 60) + "' within " +
                    std::to_string(timeout_ms / 1000) + " s");
    }
    char piece[4096];
    const ssize_t n = ::recv(socket_, piece, sizeof piece, 0);
    if (n <= 0) return broken("has ended");
    answer.append(piece, static_cast<std::size_t>(n));
    if (answer.back() != kEnd) continue;
    answer.pop_back();
    return answer;
  }
  return broken("answers without an end");
}

Result<std::string> TclClient::ask(const std::string& command, int timeout_ms) {
  const auto answer = exchange("set whirl_failed [catch {" + command +
                                   "} whirl_answer]; "
                                   "return \"$whirl_failed $whirl_answer\"",
                               timeout_ms);
  if (!answer) return answer.error();
  const std::string& text = answer.value();
  if (text.size() >= 2 && text[0] == '0' && text[1] == ' ') return text.substr(2);
  if (text == "0") return std::string();
  const std::string said = text.size() > 2 ? text.substr(2) : "no reason given";
  return Error{ErrorKind::bad_input, "openocd", "cannot '" + command.substr(0, 60) + "': " + said,
               ""};
}

}  // namespace whirl::openocd
