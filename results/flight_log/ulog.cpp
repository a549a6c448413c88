#include "results/flight_log/ulog.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>

namespace whirl::results {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35, 1};
constexpr std::size_t kFile_head_bytes = 16, kHead_bytes = 3;
constexpr int kDeepest = 8;                 // formats within formats
constexpr std::size_t kMost_fields = 4096;  // of one format, flat

template <typename T>
T get(std::span<const std::uint8_t> bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

using Getter = double (*)(std::span<const std::uint8_t>, std::size_t);
template <typename T>
double real(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<double>(get<T>(bytes, at));
}
struct BasicType {
  std::string_view name;
  std::size_t bytes;
  Getter get;
};
constexpr BasicType kBasicTypes[] = {
    {"int8_t", 1, real<std::int8_t>},   {"uint8_t", 1, real<std::uint8_t>},
    {"int16_t", 2, real<std::int16_t>}, {"uint16_t", 2, real<std::uint16_t>},
    {"int32_t", 4, real<std::int32_t>}, {"uint32_t", 4, real<std::uint32_t>},
    {"int64_t", 8, real<std::int64_t>}, {"uint64_t", 8, real<std::uint64_t>},
    {"float", 4, real<float>},          {"double", 8, real<double>},
    {"bool", 1, real<std::uint8_t>},    {"char", 1, real<std::uint8_t>},
};

struct Field {  // of a format, flat
  std::string name;
  std::size_t at;
  const BasicType* type;
};
struct Layout {
  std::vector<Field> fields;
  std::size_t bytes = 0;
};

class ULogReader {
 public:
  explicit ULogReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  ULog read() {
    const bool begins = bytes_.size() >= kFile_head_bytes &&
                        std::equal(kMagic.begin(), kMagic.end(), bytes_.begin());
    if (!begins) {
      log_.damage = "it does not begin as a ULog of version 1";
      return std::move(log_);
    }
    log_.start_us = get<std::uint64_t>(bytes_, 8);
    std::size_t at = kFile_head_bytes;
    while (at + kHead_bytes <= bytes_.size()) {
      const std::size_t size = get<std::uint16_t>(bytes_, at);
      const char type = static_cast<char>(bytes_[at + 2]);
      if (type == 0 || at + kHead_bytes + size > bytes_.size()) break;
      if (!message(type, bytes_.subspan(at + kHead_bytes, size))) {
        log_.damage =
            std::string("a message '") + type + "' at byte " + std::to_string(at) + " that is none";
        break;
      }
      at += kHead_bytes + size;
    }
    log_.records_bytes = at;
    log_.closed = at == bytes_.size() && log_.damage.empty();
    return std::move(log_);
  }

 private:
  static std::string text(std::span<const std::uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
  }

  bool message(char type, std::span<const std::uint8_t> m) {
    switch (type) {
      case 'F':
        return format(text(m));
      case 'I':
        return info(m);
      case 'P':
        return parameter(m);
      case 'A':
        return m.size() >= 3 && subscribe(get<std::uint16_t>(m, 1), text(m.subspan(3)));
      case 'D':
        return data(m);
      case 'L':
        if (m.size() < 9) return false;
        log_.texts.push_back(
            {static_cast<char>(m[0]), get<std::uint64_t>(m, 1), text(m.subspan(9))});
        return true;
      case 'O':
        if (m.size() != 2) return false;
        log_.dropouts.push_back({newest_us_, get<std::uint16_t>(m, 0)});
        return true;
      case 'B':
        return m.size() >= 40 && std::all_of(m.begin() + 8, m.begin() + 16,
                                             [](std::uint8_t flags) { return flags == 0; });
      default:
        return std::string_view("MQRCS").find(type) != std::string_view::npos;
    }
  }

  bool format(const std::string& words) {
    const std::size_t colon = words.find(':');
    if (colon == std::string::npos) return false;
    formats_[words.substr(0, colon)] = words.substr(colon + 1);
    return true;
  }

  bool info(std::span<const std::uint8_t> m) {
    const auto key = key_of(m);
    if (!key) return false;
    const std::size_t blank = key->find(' ');
    const bool is_text = key->starts_with("char[");
    log_.infos[key->substr(blank + 1)] = is_text ? text(m.subspan(1 + key->size())) : "";
    return true;
  }

  bool parameter(std::span<const std::uint8_t> m) {
    const auto key = key_of(m);
    if (!key || m.size() != 1 + key->size() + 4) return false;
    const bool whole = key->starts_with("int32_t ");
    if (!whole && !key->starts_with("float ")) return false;
    const std::size_t at = 1 + key->size();
    log_.parameters[key->substr(key->find(' ') + 1)] =
        whole ? real<std::int32_t>(m, at) : real<float>(m, at);
    return true;
  }

  static std::optional<std::string> key_of(std::span<const std::uint8_t> m) {
    if (m.empty() || m.size() < std::size_t{1} + m[0]) return std::nullopt;
    std::string key = text(m.subspan(1, m[0]));
    if (key.find(' ') == std::string::npos) return std::nullopt;
    return key;
  }

  bool subscribe(std::uint16_t id, const std::string& name) {
    Layout layout;
    if (subscribed_.count(id) != 0 || !lay_out(name, "", 0, layout)) return false;
    const auto& fields = layout.fields;
    const bool timed = std::any_of(fields.begin(), fields.end(), [](const Field& f) {
      return f.name == "timestamp" && f.type->name == "uint64_t";
    });
    if (!timed) return false;
    ULogTopic& topic = log_.topics[name];
    std::vector<std::vector<double>*> columns;
    for (const Field& field : fields) {
      columns.push_back(field.name == "timestamp" ? nullptr : &topic.columns[field.name]);
    }
    subscribed_[id] = {std::move(layout), &topic, std::move(columns)};
    return true;
  }

  bool data(std::span<const std::uint8_t> m) {
    if (m.size() < 2) return false;
    const auto found = subscribed_.find(get<std::uint16_t>(m, 0));
    if (found == subscribed_.end()) return false;
    const Subscribed& s = found->second;
    const auto fields = m.subspan(2);
    if (fields.size() != s.layout.bytes) return false;
    for (std::size_t i = 0; i < s.columns.size(); ++i) {
      const Field& field = s.layout.fields[i];
      if (s.columns[i] != nullptr) {
        s.columns[i]->push_back(field.type->get(fields, field.at));
        continue;
      }
      newest_us_ = get<std::uint64_t>(fields, field.at);
      if (!s.topic->time_us.empty() && s.topic->time_us.back() > newest_us_) return false;
      s.topic->time_us.push_back(newest_us_);
    }
    return true;
  }

  bool lay_out(const std::string& name, const std::string& prefix, int depth, Layout& layout) {
    const auto format = formats_.find(name);
    if (format == formats_.end() || depth > kDeepest) return false;
    const std::string& words = format->second;
    for (std::size_t from = 0; from < words.size();) {
      const std::size_t end = words.find(';', from), blank = words.find(' ', from);
      if (end == std::string::npos || blank >= end) return false;
      if (!add_fields(words.substr(from, blank - from),
                      prefix + words.substr(blank + 1, end - blank - 1), depth, layout)) {
        return false;
      }
      from = end + 1;
    }
    return true;
  }

  bool add_fields(const std::string& type, const std::string& name, int depth, Layout& layout) {
    const std::size_t bracket = type.find('[');
    const bool is_array = bracket != std::string::npos;
    const std::string single = type.substr(0, bracket);
    std::size_t count = 1;
    if (is_array) {
      count = 0;
      for (std::size_t i = bracket + 1; i < type.size() && type[i] != ']'; ++i) {
        if (type[i] < '0' || type[i] > '9') return false;
        count = 10 * count + static_cast<std::size_t>(type[i] - '0');
        if (count > kMost_fields) return false;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::string one = is_array ? name + "[" + std::to_string(i) + "]" : name;
      const auto* basic = std::find_if(std::begin(kBasicTypes), std::end(kBasicTypes),
                                       [&](const BasicType& t) { return t.name == single; });
      if (basic == std::end(kBasicTypes)) {
        if (!lay_out(single, one + ".", depth + 1, layout)) return false;
        continue;
      }
      if (layout.fields.size() >= kMost_fields) return false;
      layout.fields.push_back({one, layout.bytes, basic});
      layout.bytes += basic->bytes;
    }
    return true;
  }

  struct Subscribed {
    Layout layout;
    ULogTopic* topic = nullptr;
    std::vector<std::vector<double>*> columns = {};  // null: the time
  };

  std::span<const std::uint8_t> bytes_;
  ULog log_;
  std::map<std::string, std::string> formats_;
  std::map<std::uint16_t, Subscribed> subscribed_;
  std::uint64_t newest_us_ = 0;
};

}  // namespace

std::size_t ULog::samples() const {
  std::size_t count = 0;
  for (const auto& [name, topic] : topics) count += topic.time_us.size();
  return count;
}

std::uint64_t ULog::first_us() const {
  std::uint64_t first = 0;
  for (const auto& [name, topic] : topics) {
    if (!topic.time_us.empty() && (first == 0 || topic.time_us.front() < first)) {
      first = topic.time_us.front();
    }
  }
  return first;
}

std::uint64_t ULog::last_us() const {
  std::uint64_t last = 0;
  for (const auto& [name, topic] : topics) {
    if (!topic.time_us.empty()) last = std::max(last, topic.time_us.back());
  }
  return last;
}

ULog read_ulog(std::span<const std::uint8_t> bytes) {
  return ULogReader(bytes).read();
}

}  // namespace whirl::results
