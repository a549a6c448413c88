#include "harness/timing/expectations.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "harness/timing/fields.hpp"

namespace whirl::timing {
namespace {

constexpr std::size_t kWords = 7;
constexpr const char* kForm = "row KERNEL WAIT_STATES LOW HIGH SOURCE DERIVATION";

Result<Expectation> read_row(const std::vector<std::string_view>& words) {
  const auto fault = [](const std::string& what) {
    return Error{ErrorKind::bad_input, "", what, std::string("write: ") + kForm};
  };
  if (words.size() != kWords) return fault("a word is missing");
  Expectation e;
  e.kernel = words[1];
  const auto wait_states = whole_number(words[2]);
  if (!wait_states || *wait_states > 15) return fault("wait states are 0 to 15");
  e.wait_states = *wait_states;
  e.source = words[5];
  e.derivation = words[6];
  e.judged = words[3] != "-" || words[4] != "-";
  if (!e.judged) return e;
  const auto low = finite_number(words[3]), high = finite_number(words[4]);
  if (!low || !high || !(*low > 0.0) || !(*low <= *high)) return fault("not 0 < LOW <= HIGH");
  e.low_cycles = *low;
  e.high_cycles = *high;
  return e;
}

}  // namespace

Result<std::vector<Expectation>> read_expectations(std::string_view text,
                                                   const std::string& place) {
  std::vector<Expectation> all;
  std::string section;
  int number = 0;
  const auto fault = [&](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, place + ":" + std::to_string(number), what, cure};
  };
  for (const std::string_view line : lines_of(text)) {
    ++number;
    const auto words = words_of(line, kWords);
    if (words.empty() || words[0].front() == '#') continue;
    if (words[0] == "section" && words.size() > 1) {
      section = words_of(line, 2)[1];
      continue;
    }
    if (words[0] != "row") {
      return fault("'" + printable_line(words[0]) + "' begins no line of this table", kForm);
    }
    auto row = read_row(words);
    if (!row) return fault(row.error().what, row.error().cure);
    row.value().section = section;
    const std::string& kernel = row.value().kernel;
    if (std::any_of(all.begin(), all.end(),
                    [&](const Expectation& e) { return e.kernel == kernel; })) {
      return fault("'" + printable_line(kernel) + "' comes twice", "keep one of them");
    }
    all.push_back(std::move(row.value()));
  }
  if (all.empty()) return Error{ErrorKind::bad_input, place, "holds no row", kForm};
  return all;
}

}  // namespace whirl::timing
