// Lines of words: what both the images' reports and the tables of expectations are made of.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace whirl::timing {

std::vector<std::string_view> lines_of(std::string_view text);  // without their ends, CR included
// At most `most` words; the last one takes the rest of the line, blanks inside kept.
std::vector<std::string_view> words_of(std::string_view line, std::size_t most);

// Of the whole word, decimal: anything else is nothing.
std::optional<std::uint32_t> whole_number(std::string_view word);
std::optional<double> finite_number(std::string_view word);

}  // namespace whirl::timing
