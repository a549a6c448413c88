#include "io_bridges/rack/device_key.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "io_bridges/messages/messages.hpp"

namespace whirl::rack {
namespace {

std::string short_number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

double shown_value(const DeviceKey& key, double value_SI) {
  return key.dimension == Dimension::none ? value_SI : in_unit(value_SI, key.unit);
}

std::string shown(const DeviceKey& key, double value_SI) {
  if (key.kind == KeyKind::address) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%02X", static_cast<unsigned>(value_SI));
    return text;
  }
  return short_number(shown_value(key, value_SI));
}

std::string with_unit(const DeviceKey& key, const std::string& number) {
  return key.unit.empty() ? number : number + " " + key.unit;
}

std::string number_complaint(const DeviceKey& key, double value) {
  if (key.limits.hold(value)) return "";
  return with_unit(key, shown(key, value)) + " is outside " + range_text(key) +
         (key.unit.empty() ? "" : " " + key.unit);
}

// The kind, and a number from 1 to 99 with no zero before it.
bool is_bus(const std::string& text, const std::string& kind) {
  const std::size_t digit = text.find_last_not_of("0123456789") + 1;
  const std::string prefix = text.substr(0, digit), number = text.substr(digit);
  if (number.empty() || number.size() > 2 || number[0] == '0') return false;
  return prefix == kind || (kind == "usart" && prefix == "uart");
}

std::vector<std::string> alternatives(const DeviceKey& key) {
  static const std::string kOr = " or ";
  std::vector<std::string> kinds;
  std::size_t from = 0;
  for (auto to = key.unit.find(kOr); to != std::string::npos; to = key.unit.find(kOr, from)) {
    kinds.push_back(key.unit.substr(from, to - from));
    from = to + kOr.size();
  }
  kinds.push_back(key.unit.substr(from));
  return kinds;
}

std::string bus_complaint(const DeviceKey& key, const std::string& text) {
  std::string examples;
  for (const std::string& kind : alternatives(key)) {
    if (is_bus(text, kind)) return "";
    examples += (examples.empty() ? "\"" : " or \"") + kind + "1\"";
  }
  return "'" + text + "' is no bus for it: write it as " + examples;
}

bool is_pin(const std::string& text) {
  if (text.size() < 3 || text.size() > 4 || text[0] != 'P' || text[1] < 'A' || text[1] > 'K') {
    return false;
  }
  const std::string number = text.substr(2);
  const int n = std::atoi(number.c_str());
  return n >= 0 && n <= 15 && std::to_string(n) == number;
}

std::string text_complaint(const DeviceKey& key, const KeyValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (text == nullptr) return "is no text";
  if (key.kind == KeyKind::pin) {
    return is_pin(*text) ? "" : "'" + *text + "' is no pin: write it as \"PB0\"";
  }
  if (key.kind == KeyKind::file) return text->empty() ? "is no path" : "";
  if (key.kind == KeyKind::word) {
    const std::vector<std::string> words = alternatives(key);
    if (std::find(words.begin(), words.end(), *text) != words.end()) return "";
    return "'" + *text + "' is not " + unit_text(key);
  }
  return bus_complaint(key, *text);
}

// One of +x -x +y -y +z -z as a column: which axis, and its sign; 0: none of them.
std::array<int, 3> column_of(const std::string& word) {
  std::array<int, 3> column{};
  if (word.size() != 2 || (word[0] != '+' && word[0] != '-')) return column;
  if (word[1] >= 'x' && word[1] <= 'z') {
    column[static_cast<std::size_t>(word[1] - 'x')] = word[0] == '+' ? 1 : -1;
  }
  return column;
}

std::string axes_complaint(const KeyValue& value) {
  const auto* words = std::get_if<std::vector<std::string>>(&value);
  if (words == nullptr || words->size() != 3) {
    return "is no list of three axes: write it as { \"+x\", \"-y\", \"-z\" }";
  }
  const auto a = column_of((*words)[0]), b = column_of((*words)[1]), c = column_of((*words)[2]);
  const int volume = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0]);
  if (volume == 1) return "";
  const std::string all = (*words)[0] + " " + (*words)[1] + " " + (*words)[2];
  if (volume == -1) return all + " is left-handed: no part can be soldered so";
  return all + " is not x, y and z of the body in some order, each with its sign";
}

std::string triple_complaint(const DeviceKey& key, const KeyValue& value) {
  const auto* values = std::get_if<std::vector<double>>(&value);
  if (values == nullptr || values->size() != 3) return "is no list of three numbers";
  for (const double x : *values) {
    if (const std::string wrong = number_complaint(key, x); !wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

DeviceKey DeviceKey::need() const {
  DeviceKey key = *this;
  key.needed = true;
  return key;
}

DeviceKey DeviceKey::with(KeyValue value) const {
  DeviceKey key = *this;
  key.fallback = std::move(value);
  return key;
}

DeviceKey DeviceKey::with_text(std::string text) const {
  DeviceKey key = *this;
  key.fallback_text = std::move(text);
  return key;
}

DeviceKey DeviceKey::instead_of(std::string other) const {
  DeviceKey key = *this;
  key.not_with = std::move(other);
  return key;
}

DeviceKey DeviceKey::on(std::string kind_of_bus) const {
  DeviceKey key = *this;
  key.on_bus = std::move(kind_of_bus);
  return key;
}

DeviceKey DeviceKey::own(Sharing how) const {
  DeviceKey key = *this;
  key.sharing = how;
  return key;
}

DeviceKey bus_key(std::string kind, std::string about) {
  return {.path = "bus", .about = std::move(about), .kind = KeyKind::bus, .unit = std::move(kind)};
}

DeviceKey pin_key(std::string path, std::string about) {
  return {.path = std::move(path),
          .about = std::move(about),
          .kind = KeyKind::pin,
          .sharing = Sharing::own};
}

DeviceKey address_key() {
  return {.path = "address",
          .about = "on the I2C bus, seven bits",
          .kind = KeyKind::address,
          .limits = {0x08, 0x77}};
}

DeviceKey motor_key() {
  return {.path = "motor",
          .about = "its number",
          .kind = KeyKind::whole,
          .limits = {1, io::kMostMotors},
          .sharing = Sharing::own_in_type};
}

DeviceKey flag_key(std::string path, std::string about) {
  return {.path = std::move(path), .about = std::move(about), .kind = KeyKind::flag};
}

DeviceKey file_key(std::string path, std::string about) {
  return {.path = std::move(path), .about = std::move(about), .kind = KeyKind::file};
}

DeviceKey axes_key(std::string path, std::string about) {
  return {.path = std::move(path), .about = std::move(about), .kind = KeyKind::axes};
}

DeviceKey quantity_key(std::string path, Dimension dimension, std::string unit, Limits limits,
                       std::string about) {
  return {.path = std::move(path),
          .about = std::move(about),
          .kind = KeyKind::quantity,
          .dimension = dimension,
          .unit = std::move(unit),
          .limits = limits};
}

DeviceKey word_key(std::string path, std::string words, std::string about) {
  return {.path = std::move(path),
          .about = std::move(about),
          .kind = KeyKind::word,
          .unit = std::move(words)};
}

DeviceKey triple_key(std::string path, Dimension dimension, std::string unit, Limits limits,
                     std::string about) {
  DeviceKey key =
      quantity_key(std::move(path), dimension, std::move(unit), limits, std::move(about));
  key.kind = KeyKind::triple;
  return key;
}

std::string complaint(const DeviceKey& key, const KeyValue& value) {
  switch (key.kind) {
    case KeyKind::bus:
    case KeyKind::pin:
    case KeyKind::word:
    case KeyKind::file:
      return text_complaint(key, value);
    case KeyKind::address:
    case KeyKind::whole:
    case KeyKind::quantity: {
      const double* number = std::get_if<double>(&value);
      if (number == nullptr) return "is no number";
      if (key.kind != KeyKind::quantity && *number != std::floor(*number)) {
        return short_number(*number) + " is no whole number";
      }
      return number_complaint(key, *number);
    }
    case KeyKind::triple:
      return triple_complaint(key, value);
    case KeyKind::flag:
      return std::holds_alternative<bool>(value) ? "" : "is not true or false";
    case KeyKind::axes:
      return axes_complaint(value);
  }
  return "is of no kind";
}

std::string unit_text(const DeviceKey& key) {
  switch (key.kind) {
    case KeyKind::bus: {
      std::string text;
      for (const std::string& kind : alternatives(key)) {
        text += (text.empty() ? "bus " : " or ") + kind + "N";
      }
      return text;
    }
    case KeyKind::pin:
      return "pin";
    case KeyKind::word: {
      const std::vector<std::string> words = alternatives(key);
      if (words.size() == 1) return "\"" + key.unit + "\"";
      std::string text;
      for (const std::string& word : words) text += (text.empty() ? "" : "/") + word;
      return text;
    }
    case KeyKind::address:
    case KeyKind::whole:
      return "whole";
    case KeyKind::quantity:
      return key.unit.empty() ? "number" : key.unit;
    case KeyKind::triple:
      return "3 x " + key.unit;
    case KeyKind::flag:
      return "true, false";
    case KeyKind::file:
      return "path";
    case KeyKind::axes:
      return "3 axes";
  }
  return "";
}

std::string range_text(const DeviceKey& key) {
  if (std::isinf(key.limits.low) && std::isinf(key.limits.high)) return "";
  return shown(key, key.limits.low) + ".." + shown(key, key.limits.high);
}

std::string default_text(const DeviceKey& key) {
  if (key.needed) return key.on_bus.empty() ? "needed" : "needed on " + key.on_bus;
  if (!key.fallback_text.empty()) return key.fallback_text;
  if (!key.fallback) return "none";
  if (const bool* flag = std::get_if<bool>(&*key.fallback)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&*key.fallback)) return *text;
  if (const double* number = std::get_if<double>(&*key.fallback)) {
    return with_unit(key, shown(key, *number));
  }
  std::string list;
  const auto add = [&list](const std::string& item) { list += (list.empty() ? "" : " ") + item; };
  if (const auto* words = std::get_if<std::vector<std::string>>(&*key.fallback)) {
    for (const std::string& word : *words) add(word);
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&*key.fallback)) {
    for (const double number : *numbers) add(shown(key, number));
  }
  return list;
}

}  // namespace whirl::rack
