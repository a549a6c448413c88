#include "harness/cli/decode_command.hpp"

#include <cstdio>
#include <cstring>
#include <map>

#include "base/places.hpp"
#include "base/units.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/target/copper_target.hpp"
#include "io_bridges/copper/decoding.hpp"
#include "io_bridges/sigrok/capture.hpp"
#include "results/sinks/bus_row.hpp"

namespace whirl::cli {
namespace {

struct PulseCount {
  std::int64_t rises = 0, first_ns = 0, last_ns = 0;
};

// Rows of transfers; the rest is summed up. Returns how many frames could not be read.
int show(const io::Batch& all, const copper::BoardNames& names) {
  int unread = 0;
  std::map<std::uint16_t, std::string> serial;
  std::map<std::uint16_t, PulseCount> pins;
  std::fputs(results::kBus_columns, stdout);
  for (io::Reader r(all.bytes()); r.next();) {
    const std::string row = results::bus_row(r);
    if (!row.empty()) std::fputs(row.c_str(), stdout);
    const io::Header& header = r.header();
    if (header.kind == io::Kind::uart_received)
      serial[header.port] += static_cast<char>(r.payload()[0]);
    if (header.kind == io::Kind::finding) {
      ++unread;
      const std::string text(r.payload().begin(), r.payload().end());
      const auto cut = text.find('\0');
      std::fprintf(stderr, "%.9f s %s: %s\n", static_cast<double>(header.t_ns) * 1e-9,
                   text.substr(0, cut).c_str(), text.substr(cut + 1).c_str());
    }
    if (header.kind != io::Kind::pin_edge || r.as<io::PinEdge>().level == 0 || header.t_ns == 0)
      continue;
    PulseCount& pin = pins[header.port];
    if (pin.rises++ == 0) pin.first_ns = header.t_ns;
    pin.last_ns = header.t_ns;
  }
  for (const auto& [uart, text] : serial) {
    std::fprintf(stderr, "usart%u: %zu bytes\n", static_cast<unsigned>(uart), text.size());
  }
  for (const auto& [number, pin] : pins) {
    const double mean_us = pin.rises > 1 ? static_cast<double>(pin.last_ns - pin.first_ns) * 1e-3 /
                                               static_cast<double>(pin.rises - 1)
                                         : 0.0;
    std::fprintf(stderr, "pin %s: %lld rises, %.3f us apart in the mean\n",
                 names.pins[number].c_str(), static_cast<long long>(pin.rises), mean_us);
  }
  return unread;
}

}  // namespace

int decode_command(const DecodeOptions& options, const Composition& composition) {
  const auto rate = parse_quantity_as(options.rate, Dimension::frequency, "--rate");
  if (!rate) return complain(rate.error());
  if (!(rate.value() >= 1e3 && rate.value() <= 1e9)) {
    return complain(
        {ErrorKind::bad_input, "--rate", options.rate + " is outside 1 kHz..1 GHz", ""});
  }
  const auto file = find_file(options.board, {".", "whirl decode"},
                              {composition.root + "/test_plans/boards"}, ".lua");
  if (!file) return complain(file.error());
  const auto board = read_board(shown_path(file.value()));
  if (!board) return complain(board.error());
  const copper::BoardNames names = copper_names(board.value());
  copper::Decoding decoding(names);
  const auto read = sigrok::read_capture(options.capture, rate.value(), {}, decoding);
  if (!read) return complain(read.error());
  if (decoding.error()) return complain(*decoding.error());
  return show(decoding.in_order(), names) == 0 ? 0 : 1;
}

}  // namespace whirl::cli
