// The ground station: what a pilot's computer does on the radio, and what it knows of the vehicle.
//
//   Up    captured poses as VICON_POSITION_ESTIMATE; the target at 10 Hz once there is one: a place,
//         moving straight to a new one where a speed is given; a point of a path with its velocity and
//         acceleration; a velocity at a height. An attitude with a thrust instead, at 20 Hz. Commands, repeated every 300 ms with a rising
//         confirmation until COMMAND_ACK; requests for parameters (parameter_requests.hpp)
//   Wire  a command has passed when the first frame that carries it has reached the vehicle's UART
//   Down  the vehicle's telemetry, last value of each; nothing is known before it was heard
//   Ids   we are 255/190, the vehicle is 1/1
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/flight/capture.hpp"
#include "harness/flight/parameter_requests.hpp"
#include "harness/flight/set_point.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::flight {

struct PathPoint {
  Eigen::Vector3d p_W_m, v_W_mps, a_W_mps2;
};
struct HeldAttitude {
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0, yaw_rate_radps = 0.0;
  double thrust = 0.0;  // 0..1
};
using Path = std::function<PathPoint(double t_s)>;  // t from when it was begun
using Guide = std::function<SetPoint(std::int64_t t_ns)>;

// What telemetry has told, NaN until it did.
struct Telemetry {
  double state = std::nan("");  // HEARTBEAT custom_mode
  double armed = std::nan("");
  double ready = std::nan("");  // HEARTBEAT system_status: 1 standby, thus ready to arm
  double heartbeat_age_s = std::nan("");
  double height_m = std::nan(""), north_m = std::nan(""), east_m = std::nan("");
  double tilt_rad = std::nan("");
  double voltage_V = std::nan(""), current_A = std::nan(""), load = std::nan("");
  double logging = std::nan("");  // 1: SYS_STATUS calls it healthy
  std::uint64_t frames = 0;
};

class Station {
 public:
  using OnFrame = std::function<void(const io::MavlinkFrame& frame, std::int64_t t_ns)>;
  using Send = std::function<void(std::int64_t t_ns, std::span<const std::uint8_t> frame)>;

  Station();
  void on_frame(OnFrame hear) { on_frame_ = std::move(hear); }  // each that comes down, besides

  void send_pose(const CapturedPose& pose, const Send& send);
  void set_target(const std::optional<Target>& target);
  void move_target(const Target& goal, double speed_mps);  // from the present target on
  void follow(const Path& path, double yaw_rad);           // from now on
  void cruise(const Eigen::Vector3d& v_W_mps, const Target& at_height);
  // after: what target() says meanwhile
  void hold(const HeldAttitude& attitude, const Target& after);
  void guide(const Guide& guide);  // asked at each step for what is commanded then
  const std::optional<Target>& target() const { return target_; }
  const std::optional<CapturedPose>& last_pose() const { return last_pose_; }  // that was sent
  // COMMAND_LONG; waits its turn behind an earlier one that is not yet acknowledged.
  void command(std::uint16_t command, const std::array<float, 7>& param);
  void request_parameter(const std::string& name, std::optional<float> value);  // none: read it
  const ParameterRequests& parameters() const { return parameters_; }
  // What is due at t_ns: set-points, commands, requests for parameters.
  void step(std::int64_t t_ns, const Send& send);
  void receive(std::span<const std::uint8_t> bytes, std::int64_t t_ns);
  void delivered(std::span<const std::uint8_t> frame, std::int64_t t_ns);
  // Of the newest of command(), set_target() and move_target(); -1: not yet.
  std::int64_t on_wire_ns() const { return on_wire_ns_; }

  Telemetry telemetry(std::int64_t now_ns) const;
  bool command_pending() const { return !commands_.empty(); }
  // Of the last COMMAND_ACK since a command was given; or one of the two below.
  int last_result() const { return last_result_; }
  static constexpr int kWaiting = -1, kUnanswered = -2;             // given up after 20 tries
  const std::vector<std::string>& texts() const { return texts_; }  // of STATUSTEXT, all

 private:
  struct Pending {
    io::CommandLong message;
    std::int64_t next_ns = 0;
    int tries = 0;
    bool newest = true;
  };
  enum class Awaited : std::uint8_t { nothing, target, command };
  void await(Awaited what);
  void carry(const io::MavlinkFrame& frame, Awaited what);
  void send_target(std::int64_t t_ns, const Send& send);
  void send_attitude(std::int64_t t_ns, const Send& send);
  void send_command(std::int64_t t_ns, const Send& send);
  void hear(const io::MavlinkFrame& frame);
  void acknowledged(const io::CommandAck& ack);

  io::MavlinkSender sender_{255, 190, 0};
  io::MavlinkParser parser_;
  std::optional<Target> target_;
  Eigen::Vector3d goal_W_m_ = Eigen::Vector3d::Zero();
  double goal_speed_mps_ = 0.0;
  Path path_;
  std::int64_t path_start_ns_ = 0;
  std::optional<Eigen::Vector3d> cruise_W_mps_;
  std::optional<HeldAttitude> attitude_;
  Guide guide_;
  std::optional<CapturedPose> last_pose_;
  std::int64_t next_target_ns_ = 0, last_step_ns_ = 0;
  Awaited awaited_ = Awaited::nothing;
  std::vector<std::vector<std::uint8_t>> carriers_;  // frames that carry what is awaited
  std::int64_t on_wire_ns_ = -1;
  std::deque<Pending> commands_;
  ParameterRequests parameters_;
  int last_result_ = kWaiting;
  Telemetry telemetry_;
  std::vector<std::string> texts_;
  OnFrame on_frame_;
  std::int64_t heard_ns_ = 0, heartbeat_ns_ = -1;
};

}  // namespace whirl::flight
