#include "io_bridges/copper/channel_name.hpp"

#include <charconv>

namespace whirl::copper {
namespace {

struct Line {
  std::string_view kind, line;
  Role role;
};

constexpr Line kLines[] = {
    {"i2c", "scl", Role::scl},   {"i2c", "sda", Role::sda},   {"spi", "sck", Role::sck},
    {"spi", "mosi", Role::mosi}, {"spi", "miso", Role::miso}, {"usart", "tx", Role::tx},
    {"usart", "rx", Role::rx},   {"uart", "tx", Role::tx},    {"uart", "rx", Role::rx},
};

// "3_scl" after "i2c": the number, and what is behind its underscore.
std::optional<std::pair<int, std::string_view>> numbered(std::string_view text) {
  int number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc{} || number < 1 || number > 99) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!text.starts_with('_')) return std::nullopt;
  return std::pair(number, text.substr(1));
}

}  // namespace

std::optional<ChannelName> channel_name(std::string_view name) {
  if (name == "marker") return ChannelName{Role::marker};
  for (const auto& [begin, role] : {std::pair<std::string_view, Role>{"ready_", Role::ready},
                                    std::pair<std::string_view, Role>{"pin_", Role::pin}}) {
    if (!name.starts_with(begin) || name.size() == begin.size()) continue;
    return ChannelName{role, 0, std::string(name.substr(begin.size()))};
  }
  for (const Line& line : kLines) {
    if (!name.starts_with(line.kind)) continue;
    const auto rest = numbered(name.substr(line.kind.size()));
    if (!rest) continue;
    if (rest->second == line.line) return ChannelName{line.role, rest->first};
    constexpr std::string_view kSelect = "cs_";
    if (line.kind != "spi" || !rest->second.starts_with(kSelect)) continue;
    if (rest->second.size() == kSelect.size()) continue;
    return ChannelName{Role::chip_select, rest->first,
                       std::string(rest->second.substr(kSelect.size()))};
  }
  return std::nullopt;
}

}  // namespace whirl::copper
