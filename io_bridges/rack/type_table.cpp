#include "io_bridges/rack/type_table.hpp"

#include <algorithm>
#include <array>

namespace whirl::rack {
namespace {

using Row = std::array<std::string, 5>;

std::vector<Row> rows_of(const DeviceTypes& types) {
  std::vector<Row> rows = {{"key", "unit", "range", "default", "is"},
                           {"---", "---", "---", "---", "---"}};
  for (const DeviceType& type : types) {
    rows.push_back({"**" + type.name + "**", "", "", "", type.about});
    for (const DeviceKey& key : type.keys) {
      rows.push_back(
          {"`" + key.path + "`", unit_text(key), range_text(key), default_text(key), key.about});
    }
  }
  return rows;
}

}  // namespace

std::string type_table(const DeviceTypes& types) {
  const std::vector<Row> rows = rows_of(types);
  std::array<std::size_t, 5> width{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::string cell = row[i];
      cell.resize(std::max(cell.size(), width[i]), ' ');
      text += "| " + cell + " ";
    }
    text += "|\n";
  }
  return text;
}

}  // namespace whirl::rack
