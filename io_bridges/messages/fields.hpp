// What each kind of message is called and what stands in it, for files that people read.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io_bridges/messages/messages.hpp"

namespace whirl::io {

struct Field {
  enum class Type : std::uint8_t { real, int64, int32, uint32, uint16, uint8 };
  std::string_view name;  // with its unit: "speed_radps"
  Type type = Type::real;
  std::uint16_t offset = 0;  // in the payload
  std::uint16_t count = 1;   // of an array
};

std::size_t size_of(Field::Type type);  // bytes

// Behind the fields. Of a transfer: so many bytes as `kept` says, then a u32 for each.
enum class Tail : std::uint8_t { none, bytes, text, transfer };

struct KindInfo {
  Kind kind{};
  std::string_view name;
  bool to_board = false;
  std::span<const Field> fields = {};
  std::size_t size = 0;  // of the fields' struct
  Tail tail = Tail::none;
};

// Null for a number that is no kind.
const KindInfo* kind_info(Kind kind);
// "acked=1;number=3", then the tail: bytes=6A00, text=... or
// bytes=6A00;passed_ns=12500 25000; fields that the payload is too short for
// are 0, as Reader::as reads them.
std::string fields_text(const KindInfo& info, std::span<const std::uint8_t> payload);

}  // namespace whirl::io
