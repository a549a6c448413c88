#include "harness/target/bench/unproven.hpp"

#include <algorithm>
#include <array>

namespace whirl::bench {
namespace {

using Concerns = bool (*)(const BenchDescription&, LineEnds);

bool on_can(const BenchDescription& bench) {
  return !bench.cans.empty() || std::any_of(bench.pods.begin(), bench.pods.end(),
                                            [](const PodLink& link) { return link.path.empty(); });
}

bool has_line(const BenchDescription& bench) {
  return !bench.serials.empty() || !bench.instruments.empty() ||
         std::any_of(bench.pods.begin(), bench.pods.end(),
                     [](const PodLink& link) { return !link.path.empty(); });
}

struct Row {
  Unproven item;
  Concerns concerns;
};

const std::array<Row, 19> kRows{{
    {{"a board of metal behind these links", "real images have stood in for it, on virtual boards"},
     [](const BenchDescription&, LineEnds) { return true; }},
    {{"what is between an adapter's pins and the board",
      "levels, grounds and wires are measured before they are joined: see the first hours"},
     [](const BenchDescription&, LineEnds) { return true; }},
    {{"that a zero set-point, or this host's death, stops a real rotor",
      "stand-ins of the real image have been stopped: try both with the propeller off"},
     [](const BenchDescription& b, LineEnds) { return !b.bridges.empty() || !b.cans.empty(); }},
    {{"the time of a real USB bridge, and a bus that it holds low",
      "its chip has been played, in memory and to Linux's own drivers"},
     [](const BenchDescription& b, LineEnds) { return !b.bridges.empty(); }},
    {{"a USB serial adapter's latency, and whether it makes the rate",
      "lines have been this kernel's pseudo-terminals, which have neither"},
     [](const BenchDescription& b, LineEnds) { return has_line(b); }},
    {{"hardware time stamps", "no adapter has given one; frames of the tests' own carry them"},
     [](const BenchDescription& b, LineEnds) { return on_can(b); }},
    {{"a real bus-off, and the way back from it",
      "error frames have been made by hand, and by controllers that QEMU plays"},
     [](const BenchDescription& b, LineEnds) { return on_can(b); }},
    {{"a USB CAN adapter: its queues, and being pulled",
      "interfaces have been virtual ones, and SJA1000 controllers that QEMU plays"},
     [](const BenchDescription& b, LineEnds) { return on_can(b); }},
    {{"CAN nodes of other makers",
      "frames of pydronecan are understood both ways; nodes have been this house's own"},
     [](const BenchDescription& b, LineEnds) { return !b.cans.empty(); }},
    {{"SBUS by an adapter at 100000 baud 8E2, and its inverter",
      "a pseudo-terminal takes any rate, and has no level to invert"},
     [](const BenchDescription&, LineEnds l) { return l.receiver; }},
    {{"a GPS's line while its rate changes",
      "an adapter may hold bytes back longer than the 5 ms that are waited"},
     [](const BenchDescription&, LineEnds l) { return l.gps; }},
    {{"a telemetry radio's air and buffers", "its line has been a pseudo-terminal: a cable"},
     [](const BenchDescription& b, LineEnds) {
       return std::any_of(b.serials.begin(), b.serials.end(),
                          [](const SerialLink& link) { return link.mavlink; });
     }},
    {{"a command line of firmware that is not ours", "only the ESC's own has been asked"},
     [](const BenchDescription&, LineEnds l) { return l.commands; }},
    {{"a pod of metal: its SPI on copper, its DAC, its line of 3 Mbaud",
      "its image has run on a virtual board, in modelled cycles"},
     [](const BenchDescription& b, LineEnds) { return !b.pods.empty(); }},
    {{"the instruments' scales, zeros and delays",
      "their lines were written by the tests; a known weight and a knock tell them"},
     [](const BenchDescription& b, LineEnds) { return !b.instruments.empty(); }},
    {{"an analyser that streams for minutes",
      "libsigrok's demo device and files have been read, seconds long"},
     [](const BenchDescription& b, LineEnds) { return b.analyser.has_value(); }},
    {{"the marker: that RTS moves, and the analyser's clip is on it",
      "the tests have pulsed a marker of their own"},
     [](const BenchDescription& b, LineEnds) { return b.analyser.has_value(); }},
    {{"clips on copper: thresholds, cross-talk, a clock's edges at the rate",
      "wires were drawn from runs of the virtual board"},
     [](const BenchDescription& b, LineEnds) { return b.analyser.has_value(); }},
    {{"a debug probe with a core behind it: flashing, program counters, fault registers",
      "openocd has run without a probe, and with its dummy adapter"},
     [](const BenchDescription& b, LineEnds) { return b.probe.has_value(); }},
}};

}  // namespace

std::vector<Unproven> all_unproven() {
  std::vector<Unproven> all;
  all.reserve(std::size(kRows));
  for (const Row& row : kRows) all.push_back(row.item);
  return all;
}

std::vector<Unproven> unproven(const BenchDescription& bench, LineEnds lines) {
  std::vector<Unproven> all;
  for (const Row& row : kRows) {
    if (row.concerns(bench, lines)) all.push_back(row.item);
  }
  return all;
}

}  // namespace whirl::bench
