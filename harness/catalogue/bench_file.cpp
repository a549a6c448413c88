#include "harness/catalogue/bench_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

#include "harness/lua/table.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/copper/channel_name.hpp"

namespace whirl {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

int read_baud(const lua::Table& t) {
  return static_cast<int>(
      t.quantity_or("baud", Dimension::baud, 115200.0, lua::between(300.0, 12e6)));
}

void read_can(const lua::Table& t, bench::CanBusLink& link) {
  link.name = t.text("name");
  link.interface = t.text("interface");
  link.bit_rate_bps = static_cast<std::uint32_t>(
      t.quantity_or("rate", Dimension::baud, link.bit_rate_bps, lua::between(10e3, 1e6)));
}

std::optional<std::array<std::uint8_t, 16>> unique_id_of(const std::string& hex) {
  std::array<std::uint8_t, 16> id{};
  if (hex.size() != 2 * id.size()) return std::nullopt;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const char* begin = hex.data() + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, id[i], 16);
    if (error != std::errc{} || end != begin + 2) return std::nullopt;
  }
  return id;
}

void read_allocation(const lua::Table& t, bench::CanBusLink& link) {
  constexpr std::uint8_t kHighest = 125;  // 126 and 127 are tools'
  const auto id_of = [&](const lua::Table& table, const std::string& key, std::uint8_t usual) {
    return static_cast<std::uint8_t>(table.integer_or(key, usual, 1, kHighest));
  };
  bench::NodeIds& ids = link.ids;
  ids.lowest = id_of(t, "lowest", ids.lowest);
  ids.highest = id_of(t, "highest", ids.highest);
  if (ids.lowest > ids.highest) t.refuse("highest", "is below lowest");
  if (t.has("node")) link.allocator = id_of(t, "node", kHighest);
  if (!t.has("ids")) return;
  const lua::Table kept = t.table("ids");
  std::set<int> given;
  for (const std::string& key : kept.keys()) {
    const auto unique_id = unique_id_of(key);
    const std::uint8_t id = id_of(kept, key, kHighest);
    if (!unique_id) {
      kept.refuse(key, "is no unique id: 16 bytes in hex", "whirl bench check tells a node's");
    } else if (std::any_of(ids.kept.begin(), ids.kept.end(),
                           [&](const auto& one) { return one.first == *unique_id; })) {
      kept.refuse(key, "is there twice");  // in capitals, and not
    } else if (!given.insert(id).second) {
      kept.refuse(key, "has node id " + std::to_string(id) + ", which another one has");
    } else if (link.allocator == id) {
      kept.refuse(key, "has node id " + std::to_string(id) + ", which is the allocator's own");
    } else {
      ids.kept.emplace_back(*unique_id, id);
    }
  }
}

// Its line has a rate of its own.
void read_pod(const lua::Table& t, bench::BenchDescription& bench) {
  bench::PodLink link;
  link.name = t.text("name");
  link.board = t.text("pod");
  link.path = t.text_or("path", "");
  if (link.path.empty()) read_can(t, link.can);
  bench.pods.push_back(std::move(link));
}

void read_link(const lua::Table& t, bench::BenchDescription& bench) {
  if (t.has("pod")) return read_pod(t, bench);
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
  } else if (number && is_uart(bus)) {
    bench::SerialLink link{name, t.text("path"), port, read_baud(t)};
    link.mavlink = t.has("kind") && t.choice("kind", {"mavlink"}) == "mavlink";
    bench.serials.push_back(std::move(link));
  } else if (number && bus.starts_with("can")) {
    bench::CanBusLink link;
    read_can(t, link);
    link.bus = port;
    if (t.has("allocation")) read_allocation(t.table("allocation"), link);
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

// A bus's clock needs four samples to a period, or edges are lost that nobody can tell.
void check_rate(const lua::Table& t, const bench::AnalyserClips& clips,
                const std::map<std::string, double>& clocks_Hz) {
  constexpr double kSamples_per_clock = 4.0;
  for (const auto& [bus, clock_Hz] : clocks_Hz) {
    if (!clips.sees(bus) || clips.rate_Hz >= kSamples_per_clock * clock_Hz) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "%g MHz is too slow for %s at %g kHz: four samples to a clock are wanted",
                  clips.rate_Hz * 1e-6, bus.c_str(), clock_Hz * 1e-3);
    t.refuse("rate", text, "a faster rate, or no clips on " + bus);
  }
}

// links: read before; their rates are those of their buses.
bench::AnalyserClips read_analyser(const lua::Table& t, const bench::BenchDescription& bench) {
  bench::AnalyserClips clips;
  clips.driver = t.text("driver");
  clips.connection = t.text_or("connection", "");
  clips.model = t.text_or("model", "");
  clips.rate_Hz = t.quantity("rate", Dimension::frequency, lua::between(1e3, 10e9));
  clips.marker = t.text("marker");
  const lua::Table channels = t.table("channels");
  std::set<std::string> wires;
  for (const std::string& clip : channels.keys()) {
    const std::string wire = channels.text(clip);
    clips.channels[clip] = wire;
    if (!copper::channel_name(wire)) {
      channels.refuse(clip, "'" + wire + "' is no name of a wire",
                      "i2c2_scl, spi1_cs_DEVICE, pin_NAME, marker");
    }
    if (!wires.insert(wire).second) channels.refuse(clip, "'" + wire + "' has two clips");
  }
  if (wires.count("marker") == 0) {
    channels.refuse("marker",
                    "no clip is on the marker: without it the analyser's times mean nothing",
                    "D7 = \"marker\"");
  }
  std::map<std::string, double> clocks_Hz;
  for (const auto& link : bench.bridges) clocks_Hz["i2c" + std::to_string(link.bus)] = link.rate_Hz;
  for (const auto& link : bench.serials) clocks_Hz["usart" + std::to_string(link.uart)] = link.baud;
  if (t.has("clocks")) {
    const lua::Table clocks = t.table("clocks");
    for (const std::string& bus : clocks.keys()) {
      clocks_Hz[bus] = clocks.quantity(bus, Dimension::frequency, lua::between(1e3, 1e9));
    }
  }
  check_rate(t, clips, clocks_Hz);
  return clips;
}

bench::DebugProbe read_probe(const lua::Table& t) {
  bench::DebugProbe probe;
  probe.interface = t.text("interface");
  probe.target = t.text("target");
  probe.serial = t.text_or("serial", "");
  probe.speed_Hz =
      t.quantity_or("speed", Dimension::frequency, probe.speed_Hz, lua::between(1e3, 50e6));
  probe.idle = t.text_or("idle", "");
  for (const auto& [key, text] : {std::pair{"interface", &probe.interface},
                                  {"target", &probe.target},
                                  {"serial", &probe.serial}}) {
    // They become a line of openocd's own language.
    if (text->find_first_of("{}[]$;\"\\\n") != std::string::npos)
      t.refuse(key, "holds a character that no name has");
  }
  return probe;
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
  if (bench.analyser) once(places, "analyser", bench.analyser->marker);
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
  for (const auto& link : bench.pods) {
    once(names, "links", link.name);
    once(places, "links", link.path.empty() ? link.can.interface : link.path);
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
  if (t.has("analyser")) bench.analyser = read_analyser(t.table("analyser"), bench);
  if (t.has("probe")) bench.probe = read_probe(t.table("probe"));
  for (bench::BridgeLink& link : bench.bridges) {  // a slow board answers late
    for (std::int64_t* timeout_ns : {&link.timeout_ns, &link.urgent_timeout_ns}) {
      *timeout_ns = std::llround(static_cast<double>(*timeout_ns) / std::min(1.0, bench.pace));
    }
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
