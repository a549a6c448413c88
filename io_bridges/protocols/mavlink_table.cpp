// The messages we may meet, from the common and ardupilotmega dialects (mavlink/c_library_v2).
// A register table in spirit: one line per message, sorted by id.
#include <algorithm>
#include <array>

#include "io_bridges/protocols/mavlink.hpp"

namespace whirl::io {
namespace {

constexpr MavlinkInfo kMessages[] = {
    {0, "HEARTBEAT", 9, 9, 50},
    {1, "SYS_STATUS", 43, 31, 124},
    {2, "SYSTEM_TIME", 12, 12, 137},
    {4, "PING", 14, 14, 237},
    {11, "SET_MODE", 6, 6, 89},
    {20, "PARAM_REQUEST_READ", 20, 20, 214},
    {21, "PARAM_REQUEST_LIST", 2, 2, 159},
    {22, "PARAM_VALUE", 25, 25, 220},
    {23, "PARAM_SET", 23, 23, 168},
    {24, "GPS_RAW_INT", 52, 30, 24},
    {26, "SCALED_IMU", 24, 22, 170},
    {27, "RAW_IMU", 29, 26, 144},
    {29, "SCALED_PRESSURE", 16, 14, 115},
    {30, "ATTITUDE", 28, 28, 39},
    {31, "ATTITUDE_QUATERNION", 48, 32, 246},
    {32, "LOCAL_POSITION_NED", 28, 28, 185},
    {33, "GLOBAL_POSITION_INT", 28, 28, 104},
    {35, "RC_CHANNELS_RAW", 22, 22, 244},
    {36, "SERVO_OUTPUT_RAW", 37, 21, 222},
    {43, "MISSION_REQUEST_LIST", 3, 2, 132},
    {44, "MISSION_COUNT", 9, 4, 221},
    {45, "MISSION_CLEAR_ALL", 3, 2, 232},
    {47, "MISSION_ACK", 8, 3, 153},
    {49, "GPS_GLOBAL_ORIGIN", 20, 12, 39},
    {65, "RC_CHANNELS", 42, 42, 118},
    {69, "MANUAL_CONTROL", 30, 11, 243},
    {70, "RC_CHANNELS_OVERRIDE", 38, 18, 124},
    {74, "VFR_HUD", 20, 20, 20},
    {75, "COMMAND_INT", 35, 35, 158},
    {76, "COMMAND_LONG", 33, 33, 152},
    {77, "COMMAND_ACK", 10, 3, 143},
    {82, "SET_ATTITUDE_TARGET", 51, 39, 49},
    {83, "ATTITUDE_TARGET", 37, 37, 22},
    {84, "SET_POSITION_TARGET_LOCAL_NED", 53, 53, 143},
    {85, "POSITION_TARGET_LOCAL_NED", 51, 51, 140},
    {91, "HIL_CONTROLS", 42, 42, 63},
    {92, "HIL_RC_INPUTS_RAW", 33, 33, 54},
    {93, "HIL_ACTUATOR_CONTROLS", 81, 81, 47},
    {102, "VISION_POSITION_ESTIMATE", 117, 32, 158},
    {104, "VICON_POSITION_ESTIMATE", 116, 32, 56},
    {105, "HIGHRES_IMU", 63, 62, 93},
    {106, "OPTICAL_FLOW_RAD", 44, 44, 138},
    {107, "HIL_SENSOR", 65, 64, 108},
    {109, "RADIO_STATUS", 9, 9, 185},
    {111, "TIMESYNC", 18, 16, 34},
    {113, "HIL_GPS", 39, 36, 124},
    {115, "HIL_STATE_QUATERNION", 64, 64, 4},
    {132, "DISTANCE_SENSOR", 39, 14, 85},
    {138, "ATT_POS_MOCAP", 120, 36, 109},
    {140, "ACTUATOR_CONTROL_TARGET", 41, 41, 181},
    {147, "BATTERY_STATUS", 54, 36, 154},
    {148, "AUTOPILOT_VERSION", 78, 60, 178},
    {242, "HOME_POSITION", 60, 52, 104},
    {245, "EXTENDED_SYS_STATE", 2, 2, 130},
    {250, "DEBUG_VECT", 30, 30, 49},
    {251, "NAMED_VALUE_FLOAT", 18, 18, 170},
    {253, "STATUSTEXT", 54, 51, 83},
    {290, "ESC_INFO", 46, 46, 251},
    {291, "ESC_STATUS", 57, 57, 10},
    {331, "ODOMETRY", 233, 230, 91},
    {350, "DEBUG_FLOAT_ARRAY", 252, 20, 232},
    {375, "ACTUATOR_OUTPUT_STATUS", 140, 140, 251},
    {11030, "ESC_TELEMETRY_1_TO_4", 44, 44, 144},
    {11031, "ESC_TELEMETRY_5_TO_8", 44, 44, 133},
};

static_assert(std::is_sorted(std::begin(kMessages), std::end(kMessages),
                             [](const MavlinkInfo& a, const MavlinkInfo& b) {
                               return a.id < b.id;
                             }));

}  // namespace

const MavlinkInfo* mavlink_info(std::uint32_t id) {
  const auto* found = std::lower_bound(
      std::begin(kMessages), std::end(kMessages), id,
      [](const MavlinkInfo& info, std::uint32_t wanted) { return info.id < wanted; });
  return found != std::end(kMessages) && found->id == id ? found : nullptr;
}

}  // namespace whirl::io
