#include "harness/catalogue/bench_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/lua/table.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

int read_baud(const lua::Table& t) {
  return static_cast<int>(
      t.quantity_or("baud", Dimension::baud, 115200.0, lua::between(300.0, 12e6)));
}

void read_link(const lua::Table& t, bench::BenchDescription& bench) {
  const std::string name = t.text("name"), bus = t.text("bus");
  const auto number = bus_number(bus);
  const auto port = static_cast<std::uint16_t>(number.value_or(0));
  if (number && bus.starts_with("i2c")) {
    bench::BridgeLink link;
    link.name = name;
    link.kind = t.choice("bridge", {"mcp2221a", "cp2112"});
    link.serial = t.text_or("serial", "");
    link.bus = port;
    link.rate_Hz =
        t.quantity_or("rate", Dimension::frequency, link.rate_Hz, lua::between(10e3, 400e3));
    bench.bridges.push_back(std::move(link));
  } else if (number && (bus.starts_with("usart") || bus.starts_with("uart"))) {
    bench.serials.push_back({name, t.text("path"), port, read_baud(t)});
  } else if (number && bus.starts_with("can")) {
    bench::CanBusLink link;
    link.name = name;
    link.interface = t.text("interface");
    link.bus = port;
    link.bit_rate_bps = static_cast<std::uint32_t>(
        t.quantity_or("rate", Dimension::baud, link.bit_rate_bps, lua::between(10e3, 1e6)));
    bench.cans.push_back(std::move(link));
  } else {
    t.refuse("bus", "'" + bus + "' is no bus that a bench can join", "i2c1.., usart1.., can1..");
  }
}

bench::Reading read_reading(const lua::Table& t) {
  bench::Reading reading;
  reading.signal = t.text("signal");
  reading.column = static_cast<int>(t.integer_or("column", 1, 1, 64));
  const Quantity scale = t.any_quantity("scale");
  reading.scale_SI = scale.value_SI;
  reading.dimension = scale.dimension;
  if (scale.value_SI == 0.0) t.refuse("scale", "is 0: every reading would be", "\"0.0098 N\"");
  reading.zero = t.number_or("zero", 0.0);
  return reading;
}

bench::Instrument read_instrument(const lua::Table& t) {
  bench::Instrument instrument;
  instrument.name = t.text("name");
  instrument.path = t.text("path");
  instrument.baud = read_baud(t);
  instrument.delay_ns = t.duration_ns_or("delay", 0);
  for (const lua::Table& entry : t.tables("readings")) {
    instrument.readings.push_back(read_reading(entry));
  }
  if (instrument.readings.empty()) t.refuse("readings", "an instrument reads something");
  return instrument;
}

// Of any dimension; whoever knows the signal compares.
bench::Limit read_limit(const lua::Table& t) {
  bench::Limit limit;
  limit.signal = t.text("signal");
  const Quantity low = t.any_quantity("low"), high = t.any_quantity("high");
  limit.low = low.value_SI;
  limit.high = high.value_SI;
  limit.dimension = high.dimension;
  if (low.dimension != high.dimension) t.refuse("high", "is not of the dimension of low");
  if (!(limit.low < limit.high)) t.refuse("high", "is not above low");
  return limit;
}

bench::Safety read_safety(const lua::Table& t) {
  bench::Safety safety;
  safety.phrase = t.text("phrase");
  if (safety.phrase.empty()) t.refuse("phrase", "is what one says who has looked");
  safety.longest_ns = t.duration_ns("longest");
  safety.heartbeat_ns = t.duration_ns_or("heartbeat", 100 * kMs_ns);
  if (safety.heartbeat_ns < 5 * kMs_ns) t.refuse("heartbeat", "must be at least 5 ms");
  for (const lua::Table& entry : t.tables("limits")) safety.limits.push_back(read_limit(entry));
  return safety;
}

// Each name stands for one thing, and each end of a bus is joined once.
void check_names(const lua::Table& t, const bench::BenchDescription& bench) {
  std::set<std::string> names, places;
  const auto once = [&](std::set<std::string>& all, const char* key, const std::string& what) {
    if (!all.insert(what).second) t.refuse(key, "'" + what + "' is there twice");
  };
  for (const auto& link : bench.bridges) {
    once(names, "links", link.name);
    once(places, "links", "i2c" + std::to_string(link.bus));
  }
  for (const auto& link : bench.serials) {
    once(names, "links", link.name);
    once(places, "links", "usart" + std::to_string(link.uart));
    once(places, "links", link.path);
  }
  for (const auto& link : bench.cans) {
    once(names, "links", link.name);
    once(places, "links", "can" + std::to_string(link.bus));
    once(places, "links", link.interface);
  }
  for (const auto& instrument : bench.instruments) {
    once(names, "instruments", instrument.name);
    once(places, "instruments", instrument.path);
  }
}

}  // namespace

Result<bench::BenchDescription> read_bench(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  bench::BenchDescription bench;
  bench.file = path;
  bench.name = t.text("bench");
  bench.board = t.text("board");
  bench.pace = t.number_or("pace", 1.0, lua::between(0.001, 10.0));
  bench.late_ns = t.duration_ns_or("late", kMs_ns / 5);
  bench.late_share = t.quantity_or("late_share", Dimension::ratio, 0.01, lua::between(0.0, 1.0));
  for (const lua::Table& entry : t.tables("links")) read_link(entry, bench);
  for (const lua::Table& entry : t.tables("instruments")) {
    bench.instruments.push_back(read_instrument(entry));
  }
  for (bench::BridgeLink& link : bench.bridges) {  // a slow board answers late
    link.timeout_ns =
        std::llround(static_cast<double>(link.timeout_ns) / std::min(1.0, bench.pace));
  }
  if (t.has("signals")) {
    const lua::Table names = t.table("signals");
    for (const std::string& name : names.keys()) bench.signals[name] = names.text(name);
  }
  bench.safety = read_safety(t.table("safety"));
  check_names(t, bench);
  if (const auto good = t.finish(); !good) return good.error();
  return bench;
}

}  // namespace whirl
