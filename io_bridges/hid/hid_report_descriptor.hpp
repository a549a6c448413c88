// What a HID device's input reports hold, by its own report descriptor.
//
//   Reads    main items Input (variable and array, constant ones skipped), all global items, Usage, Usage
//            Minimum and Maximum, Push and Pop; long items are skipped. Output, Feature, Collection: no fields
//   Values   in the logical range; signed when the logical minimum is negative
//   Bounds   fields of 1 to 32 bits, reports up to 8 KiB, 4096 fields; beyond them, or cut short: bad_input
//   Source   USB HID 1.11, sections 5.2, 6.2.2, 8
//   Left out strings, designators, delimiters (alternative usages: the first is taken); physical units
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.hpp"

namespace whirl::io {

struct HidField {
  std::uint8_t report = 0;  // number of its report; 0: reports have none
  std::uint32_t bit = 0;    // from the report's first byte after the number
  std::uint32_t bits = 0;
  std::uint32_t usage = 0;        // page << 16 | usage; of an array: the usage of its least value
  std::int32_t min = 0, max = 0;  // logical
  bool array = false;  // its value says which usage is on, where a variable has a field for each
  bool relative = false;
};

struct HidLayout {
  std::vector<HidField> fields;
  bool numbered = false;
};

Result<HidLayout> parse_report_descriptor(std::span<const std::uint8_t> descriptor);
// The field's value in a report as it came from the device; nothing when it is in another report, or cut off.
std::optional<std::int32_t> value_in(std::span<const std::uint8_t> report, const HidField& field,
                                     bool numbered);

}  // namespace whirl::io
