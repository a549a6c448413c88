#include "io_bridges/rack/devices/spi_traffic.hpp"

#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>

namespace whirl::rack {
namespace {

bool read_pairs(const std::string& hex, RecordedTransfer& transfer) {
  if (hex.empty() || hex.size() % 4 != 0) return false;
  for (std::size_t at = 0; at < hex.size(); at += 2) {
    std::uint8_t byte = 0;
    const char* end = hex.data() + at + 2;
    if (std::from_chars(hex.data() + at, end, byte, 16).ptr != end) return false;
    (at % 4 == 0 ? transfer.mosi : transfer.miso).push_back(byte);
  }
  return true;
}

bool read_transfer(std::istringstream& words, RecordedTransfer& transfer) {
  std::string hex;
  words >> transfer.start_ns >> transfer.lead_ns >> transfer.byte_ns >> transfer.tail_ns >> hex;
  const bool sound =
      words && transfer.lead_ns >= 0 && transfer.byte_ns > 0 && transfer.tail_ns >= 0;
  return sound && read_pairs(hex, transfer);
}

}  // namespace

Result<std::vector<RecordedTransfer>> read_traffic(const std::string& path) {
  const auto wrong = [&](const std::string& where, const std::string& what) {
    return Error{ErrorKind::bad_input, where, what, "record it with test_plans/pod/record.sh"};
  };
  std::ifstream in(path);
  if (!in) return wrong(path, "no such file");
  std::vector<RecordedTransfer> all;
  std::string line;
  std::int64_t ready_ns = -1, last_ns = 0;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    char kind = ' ';
    words >> kind;
    RecordedTransfer transfer;
    const bool good = kind == 'R'   ? static_cast<bool>(words >> ready_ns)
                      : kind == 'T' ? read_transfer(words, transfer)
                                    : false;
    const std::int64_t t_ns = kind == 'R' ? ready_ns : transfer.start_ns;
    if (!good || t_ns < last_ns) {
      return wrong(path + ":" + std::to_string(number),
                   "'" + line.substr(0, 60) + "' is no line of traffic");
    }
    last_ns = t_ns;
    if (kind == 'R') continue;
    if (transfer.mosi[0] == kBurst) transfer.ready_ns = std::exchange(ready_ns, -1);
    all.push_back(std::move(transfer));
  }
  if (all.empty()) return wrong(path, "no transfer in it");
  return all;
}

}  // namespace whirl::rack
