// Serial links against pseudo-terminals that the test plays.
#include "harness/target/bench/serial_links.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

void type(io::PseudoTerminal& terminal, const std::string& text) {
  terminal.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(BoardSerial, SendsEachFrameWhenItIsDueAndTellsWhatComes) {
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  BoardSerial link({"terminal", far.path(), 1, 921'600});
  ASSERT_TRUE(link.open().ok());
  io::Batch batch;
  batch.add(io::Kind::uart_frame, 1, 0, "get kt\r\n", 8);
  batch.add(io::Kind::uart_frame, 2, 0, "other", 5);
  io::Reader r(batch.bytes());
  r.next();
  EXPECT_TRUE(link.take(r, 1000));
  r.next();
  EXPECT_FALSE(link.take(r, 1000));
  EXPECT_EQ(link.next_due_host_ns(), 1000);
  Arrivals arrivals;
  std::vector<std::uint8_t> got(64);
  ASSERT_TRUE(link.serve(999, arrivals).ok());
  EXPECT_EQ(far.read(got), 0u);
  ASSERT_TRUE(link.serve(1000, arrivals).ok());
  EXPECT_EQ(far.read(got), 8u);
  type(far, "kt 9.1\r\n");
  ASSERT_TRUE(link.serve(2000, arrivals).ok());
  ASSERT_EQ(arrivals.size(), 1u);
  EXPECT_EQ(arrivals[0].host_ns, 2000);
  EXPECT_EQ(arrivals[0].payload.size(), 8u);
}

Instrument cell(const std::string& path) {
  Instrument instrument;
  instrument.name = "cell";
  instrument.path = path;
  instrument.delay_ns = 300;
  instrument.readings.resize(2);
  instrument.readings[0] = {.signal = "thrust", .column = 2, .scale_SI = 0.01, .zero = 50.0};
  instrument.readings[1] = {.signal = "bus_current", .column = 3};
  return instrument;
}

double value_of(const Arrival& arrival) {
  io::InstrumentReading reading;
  std::memcpy(&reading, arrival.payload.data(), sizeof reading);
  return reading.value;
}

TEST(InstrumentLine, EachNumberIsASignalOfTheTimeOfItsMeasurement) {
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  InstrumentLine link(cell(far.path()), 4);
  ASSERT_TRUE(link.open().ok());
  Arrivals arrivals;
  type(far, "7 1\r\n17 250 3.5\r\n18 2");
  ASSERT_TRUE(link.serve(1000, arrivals).ok());
  ASSERT_EQ(arrivals.size(), 2u);  // the first line began before us, the last has not ended
  EXPECT_EQ(arrivals[0].port, 4);
  EXPECT_EQ(arrivals[0].host_ns, 700);
  EXPECT_EQ(value_of(arrivals[0]), 2.0);
  EXPECT_EQ(arrivals[1].port, 5);
  EXPECT_EQ(value_of(arrivals[1]), 3.5);
}

TEST(InstrumentLine, AShortLineGivesWhatItHasAndIsCounted) {
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  InstrumentLine link(cell(far.path()), 0);
  ASSERT_TRUE(link.open().ok());
  Arrivals arrivals;
  type(far, "\n17 250\n\noverload\n");
  ASSERT_TRUE(link.serve(1000, arrivals).ok());
  EXPECT_EQ(arrivals.size(), 1u);
  EXPECT_EQ(link.lines(), 2u);
  EXPECT_EQ(link.short_lines(), 2u);
}

}  // namespace
}  // namespace whirl::bench
