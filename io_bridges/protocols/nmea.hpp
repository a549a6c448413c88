// NMEA 0183 sentences: "$" body "*" checksum, CR LF. The checksum is the exclusive or of the body.
//
//   Parser  a sentence of at most 82 characters; a "$" inside begins a new one; what has no right
//           checksum is dropped and counted
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::io {

std::string nmea_sentence(std::string_view body);             // "GPTXT,..." with all around it
std::vector<std::string> nmea_fields(std::string_view body);  // between the commas

class NmeaParser {
 public:
  using BodySink = std::function<void(std::string_view body)>;

  explicit NmeaParser(BodySink on_body) : on_body_(std::move(on_body)) {}
  void add(std::uint8_t byte);
  std::uint64_t bad_checksums() const { return bad_checksums_; }

 private:
  void end();

  BodySink on_body_;
  std::string sentence_;  // behind the "$"
  bool inside_ = false;
  std::uint64_t bad_checksums_ = 0;
};

}  // namespace whirl::io
