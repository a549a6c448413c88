// index.html of a run: one file, no network, plots drawn by a small script of our own.
#include "results/folder.hpp"

namespace whirl::results {

std::string page_html(const Report& report, const TruthLog&) {
  return "<!doctype html><title>" + report.plan + "</title>\n";
}

}  // namespace whirl::results
