#include "harness/sweep/measured.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>

#include "base/rpm.hpp"
#include "base/whole_file.hpp"

namespace whirl::sweep {
namespace {

std::optional<double> number(const std::string& word) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

std::vector<std::string> words_of(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ';' || c == ','; }, ' ');
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

struct ColumnPlaces {
  int rpm = -1, J = -1, CT = -1, CP = -1;
};

ColumnPlaces places_of(const std::vector<std::string>& heads) {
  ColumnPlaces c;
  for (int i = 0; i < static_cast<int>(heads.size()); ++i) {
    std::string head = heads[static_cast<std::size_t>(i)];
    std::transform(head.begin(), head.end(), head.begin(),
                   [](unsigned char x) { return static_cast<char>(std::tolower(x)); });
    if (head == "rpm") c.rpm = i;
    if (head == "j") c.J = i;
    if (head == "ct") c.CT = i;
    if (head == "cp") c.CP = i;
  }
  return c;
}

}  // namespace

Result<MeasuredFile> read_measured(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  MeasuredFile file{std::filesystem::path(path).stem().string(), {}};
  const auto bad = [&](int line, std::string what, std::string cure) {
    return Error{ErrorKind::bad_input, path + ":" + std::to_string(line), std::move(what),
                 std::move(cure)};
  };
  const auto in_name = number(file.name.substr(file.name.rfind('_') + 1));
  std::istringstream lines(text.value());
  std::optional<ColumnPlaces> columns;
  int at = 0;
  for (std::string line; std::getline(lines, line);) {
    ++at;
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (!columns) {
      columns = places_of(words);
      if (columns->CT < 0 || columns->CP < 0) {
        return bad(at, "no columns CT and CP", "name the columns in the first line: rpm J CT CP");
      }
      if (columns->rpm < 0 && !in_name) {
        return bad(at, "no speed", "a column rpm, or name the file like prop_5000.txt");
      }
      continue;
    }
    const auto cell = [&](int column, double otherwise) -> std::optional<double> {
      if (column < 0) return otherwise;
      if (static_cast<std::size_t>(column) >= words.size()) return {};
      return number(words[static_cast<std::size_t>(column)]);
    };
    const auto rpm = cell(columns->rpm, in_name.value_or(0.0));
    const auto J = cell(columns->J, 0.0), CT = cell(columns->CT, 0.0), CP = cell(columns->CP, 0.0);
    if (!rpm || !J || !CT || !CP) return bad(at, "a number is missing", "one per named column");
    if (!(*rpm > 0.0 && *rpm <= 1e5 && *J >= 0.0 && *J < 3.0)) {
      return bad(at, "rpm or J out of range", "rpm above 0, J = V/(n D) from 0 to 3");
    }
    file.points.push_back({radps_of(*rpm), *J, *CT, *CP});
  }
  if (file.points.empty()) return bad(at, "no rows", "one row per measured point");
  return file;
}

}  // namespace whirl::sweep
