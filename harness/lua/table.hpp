// Data files in Lua (vehicles, boards, propellers): a table, read key by key, checked on the way.
//
//   Use      const auto file = lua::read_file("hp_quad.lua");          // Result<Table>
//            lua::Table t = file.value();
//            v.mass_kg = t.quantity("mass", Dimension::mass, lua::above(0.0));
//            v.arm_m = t.table("frame").quantity("arm", Dimension::length);
//            if (auto good = t.finish(); !good) return good.error();   // the first complaint of
//            all
//   Errors   kept, not returned: a getter that fails gives 0 or empty, and finish() tells the first
//            failure with file, line (where the key stands in one place only) and the path of the
//            key
//   Unknown  keys that nobody asked for, in any table that was reached, are errors of finish(), which
//            lists those that were
//   Order    keys() is sorted; nothing depends on Lua's hash order
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "base/units.hpp"

namespace whirl::lua {

// What a number may be; NaN never fits.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  bool holds(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};
inline constexpr Range kAny{};
inline Range above(double low) {
  return {.low = low, .low_open = true};
}
inline Range at_least(double low) {
  return {.low = low};
}
inline Range between(double low, double high) {
  return {.low = low, .high = high};
}

enum class Kind { flag, number, text, table };

struct Node;      // one value of the file
struct Document;  // the file: its text, its name, its first complaint

class Table {
 public:
  Table(std::shared_ptr<Document> document, const Node* node) : doc_(document), node_(node) {}

  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;  // sorted; does not count as asking for them
  std::size_t size() const;               // of the list part
  Kind kind(std::string_view key) const;  // pre: has(key)

  // "3.2 N" in SI. A bare number is taken only where the dimension is none.
  double quantity(std::string_view key, Dimension dimension, Range range = kAny) const;
  double quantity_or(std::string_view key, Dimension dimension, double fallback_SI,
                     Range range = kAny) const;
  std::vector<double> quantities(std::string_view key, Dimension dimension,
                                 Range range = kAny) const;
  std::int64_t duration_ns(std::string_view key) const;  // not negative
  std::int64_t duration_ns_or(std::string_view key, std::int64_t fallback_ns) const;

  double number(std::string_view key, Range range = kAny) const;
  double number_or(std::string_view key, double fallback, Range range = kAny) const;
  std::vector<double> numbers(std::string_view key, Range range = kAny) const;
  std::int64_t integer(std::string_view key, std::int64_t low = INT64_MIN,
                       std::int64_t high = INT64_MAX) const;
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, std::int64_t low = INT64_MIN,
                          std::int64_t high = INT64_MAX) const;
  bool flag_or(std::string_view key, bool fallback) const;
  std::string text(std::string_view key) const;
  std::string text_or(std::string_view key, std::string_view fallback) const;
  std::vector<std::string> texts(std::string_view key) const;  // empty where the key is missing
  // One of the given words.
  std::string choice(std::string_view key, const std::vector<std::string>& words) const;

  Table table(std::string_view key) const;  // missing: an error, and a table that has nothing
  std::vector<Table> tables(std::string_view key) const;  // a list of tables; empty where missing
  std::vector<Table> items() const;                       // this table's own list of tables

  // A value of any kind, for what is only passed on: what quantity() would read, of any dimension.
  Quantity any_quantity(std::string_view key) const;

  // Puts a value where a path of this table says, in place of what stands there or as a new key; see
  // base/setting.hpp. Errors  bad_input: no such element of a list, or the path leads through no table
  Result<Done> put(std::string_view path, const std::string& value);

  void refuse(std::string_view key, std::string what, std::string cure = {}) const;
  void ignore(std::string_view key) const;               // counts as asked for
  std::string place(std::string_view key) const;         // "hp_quad.lua:12: frame.arm"
  const std::string& file() const;                       // as it was given to read_file
  std::string sibling(std::string_view relative) const;  // a path beside this file
  Result<Done> finish() const;                           // of the whole document
  // As finish(), but what is below these keys of the root is somebody else's to read and finish.
  Result<Done> finish_except(const std::vector<std::string>& keys) const;

 private:
  const Node* find(std::string_view key) const;
  const Node* need(std::string_view key, const char* kind) const;
  double read_quantity(const Node& node, std::string_view key, Dimension dimension,
                       Range range) const;
  double in_range(double value, Range range, std::string_view key, std::string_view shown) const;

  std::shared_ptr<Document> doc_;
  const Node* node_;
};

// Runs the file in the sandbox (sandbox.hpp); it must return one table.
Result<Table> read_file(const std::string& path);
Result<Table> read_text(const std::string& text, const std::string& name);

}  // namespace whirl::lua
