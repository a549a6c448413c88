#include "io_bridges/hid/hid_report_descriptor.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace whirl::io {
namespace {

constexpr std::uint32_t kMost_bits = 8 * 8192;
constexpr std::size_t kMost_fields = 4096;

struct Globals {
  std::uint32_t page = 0;
  std::int32_t min = 0, max = 0;
  std::uint32_t max_unsigned = 0;
  std::uint32_t size = 0, count = 0;
  std::uint8_t report = 0;
};

class Parser {
 public:
  Result<HidLayout> parse(std::span<const std::uint8_t> bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      const std::uint8_t prefix = bytes[at];
      if (prefix == 0xFE) {  // a long item: its length is in the next byte
        if (at + 1 >= bytes.size()) return wrong(at, "it is cut short");
        at += 3 + std::size_t{bytes[at + 1]};
        continue;
      }
      const std::size_t length = (prefix & 3) == 3 ? 4 : prefix & 3;
      if (at + 1 + length > bytes.size()) return wrong(at, "it is cut short");
      const char* const what = item(prefix & 0xFC, bytes.subspan(at + 1, length));
      if (what != nullptr) return wrong(at, what);
      at += 1 + length;
    }
    return layout_;
  }

 private:
  static Error wrong(std::size_t at, const char* what) {
    return {ErrorKind::bad_input, "report descriptor, byte " + std::to_string(at), what, ""};
  }

  // What is wrong with the item, or null.
  const char* item(std::uint8_t tag, std::span<const std::uint8_t> data) {
    std::uint32_t u = 0;
    for (std::size_t i = 0; i < data.size(); ++i) u |= std::uint32_t{data[i]} << (8 * i);
    const auto unused = static_cast<int>(32 - 8 * data.size());
    const auto s = data.empty() ? 0 : static_cast<std::int32_t>(u << unused) >> unused;
    switch (tag) {
      case 0x80:
        return input(u);
      case 0x90:
      case 0xB0:
      case 0xA0:
      case 0xC0:
        locals();
        return nullptr;
      case 0x04:
        g_.page = u;
        return nullptr;
      case 0x14:
        g_.min = s;
        return nullptr;
      case 0x24:
        g_.max = s;
        g_.max_unsigned = u;
        return nullptr;
      case 0x74:
        g_.size = u;
        return nullptr;
      case 0x94:
        g_.count = u;
        return nullptr;
      case 0x84:
        if (u == 0 || u > 255) return "a report's number is 1 to 255";
        g_.report = static_cast<std::uint8_t>(u);
        layout_.numbered = true;
        return nullptr;
      case 0xA4:
        stack_.push_back(g_);
        return stack_.size() > 64 ? "too many Push" : nullptr;
      case 0xB4:
        if (stack_.empty()) return "a Pop without a Push";
        g_ = stack_.back();
        stack_.pop_back();
        return nullptr;
      case 0x08:
        return add_usage(whole(u, data.size()));
      case 0x18:
        first_ = whole(u, data.size());
        return nullptr;
      case 0x28:
        return add_usages(first_, whole(u, data.size()));
      default:
        return nullptr;
    }
  }

  std::uint32_t whole(std::uint32_t usage, std::size_t length) const {
    return length == 4 ? usage : g_.page << 16 | usage;
  }
  const char* add_usage(std::uint32_t usage) {
    usages_.push_back(usage);
    return usages_.size() > kMost_fields ? "too many usages" : nullptr;
  }
  const char* add_usages(std::uint32_t first, std::uint32_t last) {
    if (last < first || last - first >= kMost_fields)
      return "a range of usages that is empty or too long";
    for (std::uint32_t usage = first; usage <= last; ++usage) {
      if (const char* what = add_usage(usage)) return what;
    }
    return nullptr;
  }
  void locals() {
    usages_.clear();
    first_ = 0;
  }

  const char* input(std::uint32_t flags) {
    constexpr std::uint32_t kConstant = 1, kVariable = 2, kRelative = 4;
    if (g_.size > kMost_bits || g_.count > kMost_bits) return "more bits than a report has";
    std::uint32_t& bit = next_bit_[g_.report];
    const std::uint64_t end = bit + std::uint64_t{g_.size} * g_.count;
    if (end > kMost_bits) return "more bits than a report has";
    const std::uint32_t begin = std::exchange(bit, static_cast<std::uint32_t>(end));
    if ((flags & kConstant) != 0 || usages_.empty()) {
      locals();
      return nullptr;
    }
    if (g_.size == 0 || g_.size > 32) return "a field that is not of 1 to 32 bits";
    // 0..255 in one byte is written as 0xFF by many, which would be -1: unsigned unless the minimum is negative.
    const auto max = g_.min < 0 || g_.max_unsigned > INT32_MAX
                         ? g_.max
                         : static_cast<std::int32_t>(g_.max_unsigned);
    if (max < g_.min) return "a logical maximum under the minimum";
    for (std::uint32_t i = 0; i < g_.count; ++i) {
      if (layout_.fields.size() == kMost_fields) return "too many fields";
      const bool array = (flags & kVariable) == 0;
      const std::uint32_t usage =
          array ? usages_.front() : usages_[std::min<std::size_t>(i, usages_.size() - 1)];
      layout_.fields.push_back({g_.report, begin + i * g_.size, g_.size, usage, g_.min, max, array,
                                (flags & kRelative) != 0});
    }
    locals();
    return nullptr;
  }

  HidLayout layout_;
  Globals g_;
  std::vector<Globals> stack_;
  std::vector<std::uint32_t> usages_;
  std::uint32_t first_ = 0;
  std::map<std::uint8_t, std::uint32_t> next_bit_;
};

}  // namespace

Result<HidLayout> parse_report_descriptor(std::span<const std::uint8_t> descriptor) {
  return Parser().parse(descriptor);
}

std::optional<std::int32_t> value_in(std::span<const std::uint8_t> report, const HidField& field,
                                     bool numbered) {
  if (numbered) {
    if (report.empty() || report[0] != field.report) return std::nullopt;
    report = report.subspan(1);
  }
  if (field.bits == 0 || std::size_t{field.bit} + field.bits > 8 * report.size())
    return std::nullopt;
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < field.bits; ++i) {
    const std::uint32_t bit = field.bit + i;
    value |= std::uint64_t{report[bit / 8] >> (bit % 8) & 1u} << i;
  }
  const bool negative = field.min < 0 && (value >> (field.bits - 1) & 1) != 0;
  if (negative) value |= ~std::uint64_t{0} << field.bits;
  return static_cast<std::int32_t>(value);
}

}  // namespace whirl::io
