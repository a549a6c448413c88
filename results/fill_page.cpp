#include "base/check.hpp"
#include "results/page_text.hpp"

namespace whirl::results {

extern const char* const kPageStyle;
extern const char* const kPageHelpers;

namespace {

void put(std::string& page, const std::string& mark, const std::string& text) {
  const auto at = page.find(mark);
  WHIRL_CHECK(at != std::string::npos, mark);
  page.replace(at, mark.size(), text);
}

// Inside a script element "</" ends it and "<!--" begins what no "</script>" ends. In JSON a "<" stands
// in strings only, where it may be written by its number.
std::string safe_in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string fill_page(const char* page, const std::string& data_json) {
  std::string text = page;
  put(text, "%STYLE%", kPageStyle);
  put(text, "%HELPERS%", kPageHelpers);
  put(text, "%DATA%", safe_in_script(data_json));
  return text;
}

}  // namespace whirl::results
