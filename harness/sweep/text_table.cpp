#include "harness/sweep/text_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/whole_file.hpp"

namespace whirl::sweep {
namespace {

std::vector<std::string> words_of(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ';' || c == ','; }, ' ');
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string lower(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char x) { return static_cast<char>(std::tolower(x)); });
  return word;
}

}  // namespace

std::optional<double> number_in(const std::string& word) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

Result<TextTable> TextTable::read(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  TextTable table;
  table.path_ = path;
  table.name_ = std::filesystem::path(path).stem().string();
  std::istringstream lines(text.value());
  int at = 0;
  for (std::string line; std::getline(lines, line);) {
    ++at;
    auto words = words_of(line);
    if (words.empty()) continue;
    if (table.heads_.number > 0) {
      table.lines_.push_back({at, std::move(words)});
      continue;
    }
    for (std::string& word : words) word = lower(std::move(word));
    table.heads_ = {at, std::move(words)};
  }
  return table;
}

int TextTable::column(const std::string& head) const {
  const auto found = std::find(heads_.words.begin(), heads_.words.end(), lower(head));
  return found == heads_.words.end() ? -1 : static_cast<int>(found - heads_.words.begin());
}

std::string TextTable::word(const Line& line, const std::string& head) const {
  const int place = column(head);
  if (place < 0 || static_cast<std::size_t>(place) >= line.words.size()) return "";
  return line.words[static_cast<std::size_t>(place)];
}

std::optional<double> TextTable::cell(const Line& line, const std::string& head,
                                      double otherwise) const {
  if (!has(head)) return otherwise;
  return number_in(word(line, head));
}

Error TextTable::bad(int line, std::string what, std::string cure) const {
  return {ErrorKind::bad_input, path_ + ":" + std::to_string(line), std::move(what),
          std::move(cure)};
}

}  // namespace whirl::sweep
