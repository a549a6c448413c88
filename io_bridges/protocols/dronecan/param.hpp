// uavcan.protocol.param.GetSet: reads a parameter of a node, by name or by index, and sets it.
//
//   Layout  request: index 13, value, name (to the end); response: void 5, value, void 5, default, void 6, maximum,
//           void 6, minimum, name (to the end). A value is a union: its tag (3 bits: nothing, int64, float32,
//           boolean as 8 bits, text of at most 128 with its length); of the limits it has 2 bits and no boolean, no text
//   Source  dronecan/DSDL, uavcan/protocol/param/11.GetSet; the largest sizes agree (1791 and 2967 bits)
#pragma once
#include <string_view>

#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct ParamValue {
  enum Tag : std::uint8_t { empty, integer, real, boolean, text };
  std::uint8_t tag = empty;
  std::int64_t as_integer = 0;
  float as_real = 0;
  std::uint8_t as_boolean = 0;
  Bounded<char, 128> as_text{};

  template <typename F>
  void layout(F& f, bool limit = false) {
    f.skip(limit ? 6 : 5);
    layout_value(f, limit);
  }
  template <typename F>
  void layout_value(F& f, bool limit = false) {
    f.u(tag, limit ? 2 : 3);
    if (tag > (limit ? real : text)) return f.reject();
    if (tag == integer) f.i(as_integer, 64);
    if (tag == real) f.f32(as_real);
    if (tag == boolean) f.u(as_boolean, 8);
    if (tag == text) f.array(as_text, 8, [&](char& letter) { f.u_cut(letter, 8); });
  }
};

using ParamName = Bounded<char, 92>;

struct GetSetRequest {
  static constexpr DataType kType{Kind::request, 11, 0xA7B622F939D1A4D5, 223, "param.GetSet"};
  std::uint16_t index = 0;  // used when the name is empty
  ParamValue value;         // empty: only read
  ParamName name{};

  template <typename F>
  void layout(F& f) {
    f.u(index, 13);
    value.layout_value(f);
    f.tail(name, 8, [&](char& letter) { f.u_cut(letter, 8); });
  }
};

struct GetSetResponse {
  static constexpr DataType kType{Kind::response, 11, 0xA7B622F939D1A4D5, 370, "param.GetSet"};
  ParamValue value, default_value, most, least;  // all empty and no name: no such parameter
  ParamName name{};

  template <typename F>
  void layout(F& f) {
    value.layout(f);
    default_value.layout(f);
    most.layout(f, true);
    least.layout(f, true);
    f.tail(name, 8, [&](char& letter) { f.u_cut(letter, 8); });
  }
};

}  // namespace whirl::io::dronecan
