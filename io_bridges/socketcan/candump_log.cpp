#include "io_bridges/socketcan/candump_log.hpp"

#include <charconv>
#include <cstdio>

namespace whirl::io {
namespace {

template <typename T>
bool read_number(std::string_view text, int base, T& value) {
  const auto got = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return got.ec == std::errc() && got.ptr == text.data() + text.size() && !text.empty();
}

std::optional<std::int64_t> read_time(std::string_view text) {  // 1732512345.000125
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos || text.size() - dot != 7) return std::nullopt;
  std::uint32_t seconds = 0, microseconds = 0;
  if (!read_number(text.substr(0, dot), 10, seconds)) return std::nullopt;
  if (!read_number(text.substr(dot + 1), 10, microseconds)) return std::nullopt;
  return std::int64_t{seconds} * 1'000'000'000 + std::int64_t{microseconds} * 1000;
}

bool read_data(std::string_view text, CanFrame& frame) {
  if (!text.empty() && text[0] == 'R') {
    frame.remote = true;
    if (text.size() == 1) return true;
    return text.size() == 2 && read_number(text.substr(1), 10, frame.length) && frame.length <= 8;
  }
  if (text.size() % 2 != 0 || text.size() > 16) return false;
  frame.length = static_cast<std::uint8_t>(text.size() / 2);
  for (std::size_t n = 0; n < frame.length; ++n) {
    if (!read_number(text.substr(2 * n, 2), 16, frame.data[n])) return false;
  }
  return true;
}

}  // namespace

std::string candump_line(std::int64_t t_ns, std::string_view interface, const CanFrame& frame) {
  char text[40];
  std::snprintf(text, sizeof text, "(%010lld.%06lld) ",
                static_cast<long long>(t_ns / 1'000'000'000),
                static_cast<long long>(t_ns / 1000 % 1'000'000));
  std::string line = text + std::string(interface);
  std::snprintf(text, sizeof text, frame.extended ? " %08X#" : " %03X#", frame.id);
  line += text;
  if (frame.remote) return line + "R" + (frame.length == 0 ? "" : std::to_string(frame.length));
  for (const std::uint8_t byte : frame.bytes()) {
    std::snprintf(text, sizeof text, "%02X", byte);
    line += text;
  }
  return line;
}

std::optional<CandumpLine> parse_candump_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  const std::size_t close = line.find(") "), hash = line.find('#');
  if (line.empty() || line[0] != '(' || close == std::string_view::npos) return std::nullopt;
  const std::size_t space = line.find(' ', close + 2);
  if (space == std::string_view::npos || hash == std::string_view::npos || hash < space) {
    return std::nullopt;
  }
  CandumpLine out;
  const auto t_ns = read_time(line.substr(1, close - 1));
  if (!t_ns) return std::nullopt;
  out.t_ns = *t_ns;
  out.interface = line.substr(close + 2, space - close - 2);
  const std::string_view id = line.substr(space + 1, hash - space - 1);
  if ((id.size() != 3 && id.size() != 8) || !read_number(id, 16, out.frame.id)) return std::nullopt;
  out.frame.extended = id.size() == 8;
  if (out.frame.id >= (out.frame.extended ? 1u << 29 : 1u << 11)) return std::nullopt;
  if (!read_data(line.substr(hash + 1), out.frame)) return std::nullopt;
  return out;
}

}  // namespace whirl::io
