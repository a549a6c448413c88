#include "io_bridges/protocols/nmea.hpp"

#include <cstdio>

namespace whirl::io {
namespace {

constexpr std::size_t kLongest = 82;

std::string checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char text[3];
  std::snprintf(text, sizeof text, "%02X", sum & 0xFF);
  return text;
}

}  // namespace

std::string nmea_sentence(std::string_view body) {
  return "$" + std::string(body) + "*" + checksum(body) + "\r\n";
}

std::vector<std::string> nmea_fields(std::string_view body) {
  std::vector<std::string> fields(1);
  for (const char c : body) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

void NmeaParser::add(std::uint8_t byte) {
  const char c = static_cast<char>(byte);
  if (c == '$') {
    inside_ = true;
    sentence_.clear();
  } else if (inside_ && (c == '\r' || c == '\n')) {
    inside_ = false;
    end();
  } else if (inside_) {
    sentence_ += c;
    inside_ = sentence_.size() < kLongest && byte >= ' ' && byte <= '~';
  }
}

void NmeaParser::end() {
  const std::size_t star = sentence_.rfind('*');
  if (star == std::string::npos ||
      sentence_.substr(star + 1) != checksum(sentence_.substr(0, star))) {
    ++bad_checksums_;
    return;
  }
  on_body_(std::string_view(sentence_).substr(0, star));
}

}  // namespace whirl::io
