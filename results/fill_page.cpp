#include "harness/base/check.hpp"
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

// Inside a script element only "</" could end it too soon.
std::string safe_in_script(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] == '<' && i + 1 < text.size() && text[i + 1] == '/') out += '\\';
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
