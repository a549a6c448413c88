// Measured rows as people publish them: a first line that names the columns, then a row per line.
//
//   In      words apart by spaces, commas or semicolons; '#' begins a remark; the heads' case does not matter
//   Errors  bad_input with file and line
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::sweep {

class TextTable {
 public:
  struct Line {
    int number = 0;  // in the file
    std::vector<std::string> words;
  };

  static Result<TextTable> read(const std::string& path);

  int column(const std::string& head) const;  // -1: none of that name
  bool has(const std::string& head) const { return column(head) >= 0; }
  // Of a line: `otherwise` where the table has no such column, nothing where the line's word is no number.
  std::optional<double> cell(const Line& line, const std::string& head, double otherwise) const;
  std::string word(const Line& line, const std::string& head) const;  // "": no such column or word

  const std::string& name() const { return name_; }  // of the file, without folder and ending
  const Line& heads() const { return heads_; }
  const std::vector<Line>& lines() const { return lines_; }
  Error bad(int line, std::string what, std::string cure) const;

 private:
  std::string path_, name_;
  Line heads_;
  std::vector<Line> lines_;
};

// The whole word as a finite number.
std::optional<double> number_in(const std::string& word);

}  // namespace whirl::sweep
