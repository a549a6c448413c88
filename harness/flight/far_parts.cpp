#include "harness/flight/far_parts.hpp"

#include <algorithm>
#include <span>

#include "io_bridges/board_description/pod_host.hpp"

namespace whirl::flight {

bool FarParts::hears(const io::Header& head) const {
  return head.kind == io::Kind::uart_received && head.port == kPodHostUart && !boards_.empty() &&
         head.board == boards_.front();
}

bool FarParts::finds(const io::Header& head) const {
  return head.kind == io::Kind::gnss_solution &&
         std::find(boards_.begin(), boards_.end(), head.board) != boards_.end();
}

bool FarParts::is_esc(const io::Header& head) const {
  return head.kind == io::Kind::esc_setpoint && head.board == board_of(head.port);
}

void FarParts::on_message(const io::Reader& message) {
  for (const std::uint8_t byte : message.payload()) {
    if (byte != '\n') {
      coming_ += static_cast<char>(byte);
      continue;
    }
    heard_.push_back(coming_);
    coming_.clear();
    open_ = false;
  }
}

void FarParts::send(std::int64_t t_ns, const io::BodyMotion& motion, io::Batch& sensed) {
  for (const std::uint8_t board : boards_) {
    const io::Header head{t_ns, io::Kind::body_motion, board, 0, 0};
    sensed.add(head, {{reinterpret_cast<const std::uint8_t*>(&motion), sizeof motion}});
  }
  if (to_send_.empty()) return;
  const io::Header head{t_ns, io::Kind::uart_frame, boards_.front(), kPodHostUart, 0};
  sensed.add(head, {{reinterpret_cast<const std::uint8_t*>(to_send_.data()), to_send_.size()}});
  to_send_.clear();
}

std::uint8_t FarParts::board_of(int motor) const {
  const auto played = escs_.find(motor);
  return played == escs_.end() ? std::uint8_t{0} : played->second;
}

void FarParts::send_esc(std::int64_t t_ns, std::uint16_t motor, const io::EscState& state,
                        io::Batch& sensed) const {
  const io::Header head{t_ns, io::Kind::esc_state, board_of(motor), motor, 0};
  sensed.add(head, {{reinterpret_cast<const std::uint8_t*>(&state), sizeof state}});
}

Result<Done> FarParts::say(const std::string& line) {
  if (boards_.empty()) {
    return Error{ErrorKind::bad_input, "", "nobody listens to lines here",
                 "t:ask is for stands, and for the host of a pod"};
  }
  if (open_) return Error{ErrorKind::bad_input, "", "the line before is not answered yet", ""};
  open_ = true;
  to_send_ = line + "\n";
  return Done{};
}

}  // namespace whirl::flight
