// The texts of the pages, put into the program by the build (page.html, charts.html and what they
// share).
#pragma once
#include <string>

namespace whirl::results {

extern const char* const kRunPage;
extern const char* const kChartsPage;

// The page with its style, its helpers and its data in their places.
std::string fill_page(const char* page, const std::string& data_json);

}  // namespace whirl::results
