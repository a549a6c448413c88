// One more device: from a line of a board file to bytes on a bus, a message and a fault.
#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "io_bridges/qemu/board/device_rack.hpp"
#include "io_bridges/qemu/board/tests/toy_device.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"
#include "io_bridges/rack/type_table.hpp"

namespace whirl::board_test {
namespace {

rack::DeviceTypes with_toy() {
  rack::DeviceTypes types = rack::device_types();
  types.push_back(toy_type());  // the one line
  return types;
}

Result<BoardDescription> read(const std::string& keys) {
  const ScratchFolder folder;
  const std::string path = folder.file("b.lua");
  std::ofstream(path) << "return { board = 'b', mcu = 'stm32f405rg', hse = '8 MHz', devices = {\n"
                      << "{ name = 'toy', type = 'toy_thermometer', " << keys << " } } }";
  return read_board(path, with_toy());
}

struct Bench {
  void send(io::Kind kind, const auto& payload) {
    io::Batch batch;
    batch.add(kind, 0, 5, payload);
    io::Reader reader(batch.bytes());
    ASSERT_TRUE(reader.next());
    EXPECT_TRUE(rack.on_message(reader));
  }
  std::uint8_t answer() {
    io::I2cBus& bus = *chip.chip().i2c(1);
    bus.start(10);
    EXPECT_TRUE(bus.address(0x48, true, 20));
    const std::uint8_t byte = bus.read(false, 30);
    bus.stop(40);
    return byte;
  }
  std::vector<io::Kind> kinds() const {
    std::vector<io::Kind> all;
    for (io::Reader r(happened.bytes()); r.next();) all.push_back(r.header().kind);
    return all;
  }

  stm32::ChipBench chip;
  io::Batch happened;
  const rack::DeviceTypes types = with_toy();
  board::DeviceRack rack{
      {chip.events(), chip.chip(), happened, [](const io::Finding&) {}, 1, types}};
};

TEST(ToyDevice, ReceivesBytesAMessageAndAFault) {
  const auto board = read("bus = 'i2c1', address = 0x48, params = { offset = 2 }");
  ASSERT_TRUE(board) << board.error().message();
  Bench b;
  const auto built = b.rack.build(board.value());
  ASSERT_TRUE(built) << built.error().message();
  EXPECT_EQ(b.answer(), 90);  // 288.15 K, 2 K too much, less 200
  io::BodyMotion motion;
  motion.air_temperature_K = 273.15;
  b.send(io::Kind::body_motion, motion);
  EXPECT_EQ(b.answer(), 75);
  io::FaultCommand fault;
  fault.number = 7;
  fault.kind = static_cast<std::uint32_t>(io::FaultKind::sensor_wrong_identity);
  fault.end_ns = io::kNever;
  fault.bus = 1;
  fault.address = 0x48;
  b.send(io::Kind::fault, fault);
  EXPECT_EQ(b.answer(), 0xEE);
  EXPECT_EQ(b.kinds(), (std::vector<io::Kind>{io::Kind::i2c_transaction, io::Kind::i2c_transaction,
                                              io::Kind::fault_applied, io::Kind::i2c_transaction}));
}

TEST(ToyDevice, ItsKeysAreCheckedAndListedLikeAllOthers) {
  const auto said = [](const std::string& keys) {
    const auto board = read(keys);
    return board ? "" : board.error().message();
  };
  EXPECT_NE(said("bus = 'i2c1', address = 0x48, colour = 'red'")
                .find("it has name, type, bus, address, params.offset"),
            std::string::npos);
  EXPECT_NE(
      said("bus = 'i2c1', address = 0x48, params = { offset = 11 }").find("outside -10..10 K"),
      std::string::npos);
  EXPECT_NE(said("bus = 'spi1', address = 0x48").find("is no bus for it"), std::string::npos);
  EXPECT_NE(rack::type_table(with_toy()).find("**toy_thermometer**"), std::string::npos);
}

TEST(ToyDevice, AMessageThatNobodyTakesIsSaidToBeSo) {
  Bench b;
  ASSERT_TRUE(b.rack.build({.name = "b"}));
  io::Batch batch;
  batch.add(io::Kind::body_motion, 0, 5, io::BodyMotion{});
  io::Reader reader(batch.bytes());
  ASSERT_TRUE(reader.next());
  EXPECT_FALSE(b.rack.on_message(reader));
}

}  // namespace
}  // namespace whirl::board_test
