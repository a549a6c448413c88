// DroneCAN messages against frames that another implementation made (pydronecan 08cda37a over DSDL b4653c7a), both
// ways. BatteryInfo, GetNodeInfo, Allocation and param.GetSet: frames of dronecan_vectors.py beside this file, which
// writes the DSDL's fields as strings of bits, takes float16 and the CRC from Python's own library, and makes
// pydronecan's frames of RawIMU and esc.Status as well; param.GetSet also by hand from the DSDL.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "base/near.hpp"
#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/types.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::io::dronecan {
namespace {

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::vector<std::uint8_t> from_hex(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// "e8..80 / 00..": the frames of a transfer, as the table of facts prints them.
std::string printed(const std::vector<CanFrame>& frames) {
  std::string text;
  for (const CanFrame& frame : frames) {
    text += (text.empty() ? "" : " / ") + hex(frame.bytes());
  }
  return text;
}

std::vector<CanFrame> parsed(std::uint32_t id, const std::string& text) {
  std::vector<CanFrame> frames;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(" / ", at), text.size());
    const auto bytes = from_hex(text.substr(at, end - at));
    CanFrame frame{.id = id, .extended = true, .length = static_cast<std::uint8_t>(bytes.size())};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    frames.push_back(frame);
    at = end + 3;
  }
  return frames;
}

// Out: the very frames. In: the message, which encodes to the same payload again.
template <typename Message>
std::optional<Message> expect_both_ways(const Message& message, const Header& header,
                                        std::uint32_t id, const std::string& frames) {
  const DataType& type = Message::kType;
  const Payload payload = encode(message);
  const auto made = frames_of(header, type.signature, payload.bytes());
  EXPECT_EQ(printed(made), frames);
  EXPECT_EQ(made.front().id, id);

  Assembler assembler(known_type);
  const Transfer* transfer = nullptr;
  for (const CanFrame& frame : parsed(id, frames)) {
    EXPECT_EQ(transfer, nullptr);
    transfer = assembler.take(frame, 0);
  }
  if (transfer == nullptr) {
    ADD_FAILURE() << "no transfer";
    return std::nullopt;
  }
  EXPECT_EQ(transfer->header, header);
  const auto again = decode<Message>(transfer->payload);
  EXPECT_TRUE(again && hex(encode(*again).bytes()) == hex(transfer->payload));
  return again;
}

template <typename Message>
std::optional<Message> expect_both_ways(const Message& message, std::uint8_t source,
                                        std::uint8_t transfer_id, std::uint8_t priority,
                                        std::uint32_t id, const std::string& frames) {
  return expect_both_ways(message,
                          {.type_id = Message::kType.id,
                           .priority = priority,
                           .source = source,
                           .transfer_id = transfer_id},
                          id, frames);
}

// Of a service: asked by node 10 of node 20, or answered.
template <typename Message>
std::optional<Message> expect_service(const Message& message, std::uint8_t transfer_id,
                                      std::uint8_t priority, std::uint32_t id,
                                      const std::string& frames) {
  const bool asked = Message::kType.kind == Kind::request;
  return expect_both_ways(message,
                          {.kind = Message::kType.kind,
                           .type_id = Message::kType.id,
                           .priority = priority,
                           .source = static_cast<std::uint8_t>(asked ? 10 : 20),
                           .destination = static_cast<std::uint8_t>(asked ? 20 : 10),
                           .transfer_id = transfer_id},
                          id, frames);
}

template <std::size_t N>
void set(Bounded<char, N>& text, std::string_view letters) {
  for (const char letter : letters) text.add(letter);
}

template <typename T, std::size_t N>
Bounded<T, N> list(std::initializer_list<T> items) {
  Bounded<T, N> values;
  for (const T& item : items) values.add(item);
  return values;
}

TEST(DronecanGolden, NodeStatus) {
  const NodeStatus status{.uptime_s = 0x01020304, .health = 1, .mode = 3, .vendor_code = 0xABCD};
  const auto got = expect_both_ways(status, 42, 5, 24, 0x1801552A, "0403020158cdabc5");
  EXPECT_EQ(got->uptime_s, 0x01020304u);
  EXPECT_EQ(got->health, 1);
  EXPECT_EQ(got->mode, 3);
  EXPECT_EQ(got->vendor_code, 0xABCD);
}

TEST(DronecanGolden, RawCommandOfFourEscsIsOneFrame) {
  const RawCommand up{list<std::int16_t, kMost_escs>({1000, 2000, 3000, 4000})};
  EXPECT_EQ(expect_both_ways(up, 10, 0, 8, 0x0804060A, "e80f407b82e80fc0")->commands, up.commands);
  const RawCommand ends{list<std::int16_t, kMost_escs>({8191, -8192, 1, -1})};
  EXPECT_EQ(expect_both_ways(ends, 10, 1, 8, 0x0804060A, "ff7c0200103fffc1")->commands,
            ends.commands);
}

TEST(DronecanGolden, RpmCommandOfFourEscsIsTwoFrames) {
  const RpmCommand speeds{list<std::int32_t, kMost_escs>({5000, 6000, -7000, 8000})};
  const auto got = expect_both_ways(speeds, 10, 2, 8, 0x0804070A, "a82688131c05ca82 / 8e4d007c62");
  EXPECT_EQ(got->speeds_rpm, speeds.speeds_rpm);
}

TEST(DronecanGolden, EscStatus) {
  const EscStatus status{.voltage_V = 16,
                         .current_A = 10,
                         .temperature_K = 300,
                         .speed_rpm = 5000,
                         .power_pct = 50,
                         .index = 2};
  const auto got = expect_both_ways(status, 20, 7, 16, 0x10040A14,
                                    "33a5000000000087 / 4c0049b05c881327 / 190847");
  EXPECT_EQ(got->voltage_V, 16);
  EXPECT_EQ(got->speed_rpm, 5000);
  EXPECT_EQ(got->power_pct, 50);
  EXPECT_EQ(got->index, 2);
}

TEST(DronecanGolden, ArmingStatus) {
  EXPECT_EQ(expect_both_ways(ArmingStatus{255}, 10, 3, 16, 0x10044C0A, "ffc3")->status, 255);
}

TEST(DronecanGolden, AirData) {
  const StaticPressure pressure{101325, 4};
  EXPECT_EQ(expect_both_ways(pressure, 30, 0, 16, 0x1004041E, "80e6c5470044c0")->pressure_Pa,
            101325);
  const StaticTemperature temperature{298.15f, 0};
  const auto got = expect_both_ways(temperature, 30, 0, 16, 0x1004051E, "a95c0000c0");
  EXPECT_TRUE(near(got->temperature_K, 298.15, counts(0.5, 0.25)));  // float16 from 256 to 512
}

TEST(DronecanGolden, MagneticFieldStrength2) {
  const MagneticFieldStrength2 field{.field_Ga = {0.2f, -0.05f, 0.4f}};
  const auto got = expect_both_ways(field, 30, 0, 16, 0x1003EA1E, "00663266aa6636c0");
  EXPECT_TRUE(near(got->field_Ga[1], -0.05, counts(0.5, 0x1p-15)));
}

TEST(DronecanGolden, RawImuIsSevenFrames) {
  const RawImu imu{.time_us = 1'000'000,
                   .rate_radps = {0.01f, -0.02f, 0.03f},
                   .acceleration_mps2 = {0, 0, -9.8125f}};
  const auto got = expect_both_ways(imu, 30, 0, 16, 0x1003EB1E,
                                    "b5d040420f000080 / 0000000000001f20 / 211fa5ae27000000 / "
                                    "0000000000000020 / 0000000000000000 / e8c8000000000020 / "
                                    "0000000000000040");
  EXPECT_EQ(got->time_us, 1'000'000u);
  EXPECT_EQ(got->acceleration_mps2[2], -9.8125f);
}

TEST(DronecanGolden, Fix2) {
  const Fix2 fix{.gnss_time_us = 1'700'000'000'000'000,
                 .time_standard = Fix2::utc,
                 .longitude_1e8_deg = 854'100'000,
                 .latitude_1e8_deg = 4'737'700'000,
                 .height_ellipsoid_mm = 500'000,
                 .height_sea_mm = 452'000,
                 .v_WB_W_mps = {1, 2, -0.5f},
                 .satellites = 12,
                 .status = Fix2::fix_3d,
                 .pdop = 1.5f};
  const auto got = expect_both_ways(fix, 40, 0, 16, 0x10042728,
                                    "d1f6000000000080 / 000000401e182420 / 0a06400000208800 / "
                                    "e83205048318d020 / 482841c507283000 / 0000803f00000020 / "
                                    "40000000bf330000 / 00003e60");
  EXPECT_EQ(got->latitude_1e8_deg, 4'737'700'000);
  EXPECT_EQ(got->height_sea_mm, 452'000);
  EXPECT_EQ(got->satellites, 12);
  EXPECT_EQ(got->ecef_count, 0);
}

TEST(DronecanGolden, TheFirstRequestForANodeId) {
  const Allocation request{.first_part = true,
                           .unique_id = list<std::uint8_t, 16>({1, 2, 3, 4, 5, 6})};
  EXPECT_EQ(hex(encode(request).bytes()), "01010203040506");
  const auto header = parse_can_id(0x1E214500);  // libcanard's discriminator
  ASSERT_TRUE(header);
  EXPECT_EQ(header->source, 0);
  EXPECT_EQ(header->type_id, 1);
  EXPECT_EQ(header->priority, 30);
}

UniqueId from_0x11() {
  UniqueId id{};
  for (std::size_t i = 0; i < id.size(); ++i) id[i] = static_cast<std::uint8_t>(0x11 + i);
  return id;
}

Allocation of_bytes(std::size_t from, std::size_t end, std::uint8_t node_id = 0,
                    bool first = false) {
  Allocation message{.node_id = node_id, .first_part = first};
  for (std::size_t i = from; i < end; ++i) message.unique_id.add(from_0x11()[i]);
  return message;
}

TEST(DronecanGolden, AllocationsThreeRequestsOfANodeWithoutId) {
  const std::pair<Allocation, std::string> parts[] = {{of_bytes(0, 6, 0, true), "01111213141516c0"},
                                                      {of_bytes(6, 12), "001718191a1b1cc1"},
                                                      {of_bytes(12, 16, 33), "421d1e1f20c2"}};
  std::uint8_t transfer_id = 0;
  for (const auto& [part, frame] : parts) {
    const Header header{.type_id = 1, .priority = 30, .transfer_id = transfer_id++};
    const auto id = can_id(header, encode(part).bytes());  // its discriminator is anybody's choice
    const auto got = expect_both_ways(part, header, id, frame);
    EXPECT_EQ(got->unique_id, part.unique_id);
    EXPECT_EQ(got->node_id, part.node_id);
    EXPECT_EQ(got->first_part, part.first_part);
  }
}

TEST(DronecanGolden, AllocationsThreeAnswers) {
  expect_both_ways(of_bytes(0, 6), 10, 0, 30, 0x1E00010A, "00111213141516c0");
  expect_both_ways(of_bytes(0, 12), 10, 1, 30, 0x1E00010A,
                   "91d3001112131481 / 15161718191a1b21 / 1c41");
  const auto got = expect_both_ways(of_bytes(0, 16, 125), 10, 2, 30, 0x1E00010A,
                                    "613dfa1112131482 / 15161718191a1b22 / 1c1d1e1f2042");
  EXPECT_EQ(got->node_id, 125);
  EXPECT_EQ(got->unique_id.items, from_0x11());
}

TEST(DronecanGolden, BatteryInfo) {
  BatteryInfo battery{.temperature_K = 300,
                      .voltage_V = 15.5f,
                      .current_A = -12.25f,
                      .mean_power_10s_W = 180,
                      .remaining_Wh = 30.5f,
                      .full_Wh = 37,
                      .hours_to_full = 1.5f,
                      .status_flags = 0x2A5,
                      .charge_pct = 83,
                      .charge_deviation_pct = 4,
                      .battery_id = 2,
                      .model_instance = 0xDEADBEEF};
  set(battery.model_name, "hv_4s");
  const auto got = expect_both_ways(battery, 45, 9, 16, 0x1004442D,
                                    "e901b05cc04b2089 / caa059a04fa05029 / 003ea55fe9840209 / "
                                    "efbeadde68765f29 / 347349");
  EXPECT_EQ(got->current_A, -12.25f);
  EXPECT_EQ(got->status_flags, 0x2A5);
  EXPECT_EQ(got->health_pct, BatteryInfo::kUnknown_pct);
  EXPECT_EQ(got->charge_pct, 83);
  EXPECT_EQ(got->model_name, battery.model_name);
}

TEST(DronecanGolden, BatteryInfoWithoutAName) {
  const BatteryInfo battery{
      .voltage_V = 11.1f, .status_flags = 1, .health_pct = 0, .charge_pct = 100};
  const auto got =
      expect_both_ways(battery, 45, 0, 16, 0x1004442D,
                       "c54500008d490080 / 0000000000000020 / 0000010032000000 / 0000000060");
  EXPECT_TRUE(near(got->voltage_V, 11.1, counts(0.5, 0x1p-7)));  // float16 from 8 to 16
  EXPECT_EQ(got->model_name.size, 0u);
}

TEST(DronecanGolden, GetNodeInfo) {
  expect_service(GetNodeInfoRequest{}, 3, 30, 0x1E01948A, "c3");
  GetNodeInfoResponse info{.status = {.uptime_s = 0x01020304,
                                      .health = 1,
                                      .mode = 3,
                                      .sub_mode = 5,
                                      .vendor_code = 0xABCD},
                           .software_major = 2,
                           .software_minor = 18,
                           .software_flags = 3,
                           .vcs_commit = 0xD001F897,
                           .image_crc = 0x0123456789ABCDEF,
                           .hardware_major = 4,
                           .hardware_minor = 1,
                           .unique_id = from_0x11(),
                           .certificate = list<std::uint8_t, 255>({0x5A, 0xA5})};
  info.set_name("org.am32");
  const auto got =
      expect_service(info, 3, 30, 0x1E010A94,
                     "210c040302015d83 / cdab02120397f823 / 01d0efcdab896703 / 4523010401111223 / "
                     "1314151617181903 / 1a1b1c1d1e1f2023 / 025aa56f72672e03 / 616d333263");
  EXPECT_EQ(got->image_crc, 0x0123456789ABCDEFu);
  EXPECT_EQ(got->unique_id, from_0x11());
  EXPECT_EQ(got->certificate.items[1], 0xA5);
  EXPECT_EQ(got->name_text(), "org.am32");
}

TEST(DronecanGolden, GetSetRequests) {
  GetSetRequest real{.index = 0x1234, .value = {.tag = ParamValue::real, .as_real = -0.75f}};
  set(real.name, "motor_kv");
  const auto got =
      expect_service(real, 1, 20, 0x140B948A, "60b0349200004081 / bf6d6f746f725f21 / 6b7641");
  EXPECT_EQ(got->value.as_real, -0.75f);
  EXPECT_EQ(got->name, real.name);
  GetSetRequest text{.value = {.tag = ParamValue::text}};
  set(text.value.as_text, "hello");
  set(text.name, "greeting");
  const auto words =
      expect_service(text, 2, 20, 0x140B948A, "046a000405686582 / 6c6c6f6772656522 / 74696e6742");
  EXPECT_EQ(words->value.as_text, text.value.as_text);
}

TEST(DronecanGolden, GetSetResponses) {
  const auto whole = [](std::int64_t value) {
    return ParamValue{.tag = ParamValue::integer, .as_integer = value};
  };
  GetSetResponse gain{.value = whole(-7),
                      .default_value = whole(0x1122334455667788),
                      .most = whole(100),
                      .least = whole(-100)};
  set(gain.name, "gain");
  const auto got =
      expect_service(gain, 1, 20, 0x140B0A94,
                     "d1a901f9ffffff81 / ffffffff01887721 / 6655443322110101 / 6400000000000021 / "
                     "00019cffffffff01 / ffffff6761696e61");
  EXPECT_EQ(got->value.as_integer, -7);
  EXPECT_EQ(got->least.as_integer, -100);
  GetSetResponse word{.value = {.tag = ParamValue::text},
                      .default_value = {.tag = ParamValue::boolean, .as_boolean = 1},
                      .most = {},
                      .least = {}};
  set(word.value.as_text, "abc");
  set(word.name, "word");
  const auto words =
      expect_service(word, 2, 20, 0x140B0A94, "24c7040361626382 / 03010000776f7222 / 6442");
  EXPECT_EQ(words->value.as_text, word.value.as_text);
  EXPECT_EQ(words->default_value.as_boolean, 1);
  EXPECT_EQ(words->most.tag, ParamValue::empty);
}

TEST(DronecanGolden, GetSetRequestByHand) {
  GetSetRequest read;
  read.index = 5;
  read.name.add('a');
  EXPECT_EQ(hex(encode(read).bytes()), "050061");
  // Index 0x1234: 34, then 10010; the tag 001 of an integer; -2; "kv".
  const auto set = decode<GetSetRequest>(from_hex("3491feffffffffffffff6b76"));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->index, 0x1234);
  EXPECT_EQ(set->value.as_integer, -2);
  EXPECT_EQ(set->name.size, 2u);
  EXPECT_EQ(hex(encode(*set).bytes()), "3491feffffffffffffff6b76");
}

TEST(DronecanGolden, GetSetResponseByHand) {
  // 00000 010 float 1.5; 00000 011 true; 000000 10 float 2; 000000 00 nothing; "g".
  const std::string bytes =
      "020000c03f0301020000004000"
      "67";
  const auto got = decode<GetSetResponse>(from_hex(bytes));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.as_real, 1.5f);
  EXPECT_EQ(got->default_value.as_boolean, 1);
  EXPECT_EQ(got->most.as_real, 2.0f);
  EXPECT_EQ(got->least.tag, ParamValue::empty);
  EXPECT_EQ(got->name.items[0], 'g');
  EXPECT_EQ(hex(encode(*got).bytes()), bytes);
}

}  // namespace
}  // namespace whirl::io::dronecan
