#include "plant/validation/report.hpp"

#include <sstream>

namespace whirl::plant {

Rows read_rows(const std::string& text, std::size_t columns) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; row.size() < columns && words >> value;) row.push_back(value);
    if (row.size() == columns) rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Proof> proofs_of(const Report& report) {
  std::vector<Proof> proofs;
  for (const Plot& plot : report.plots) {
    Proof proof{report.title + ": " + plot.title, plot.x_label, plot.y_label, report.source};
    for (const Series& s : plot.series) {
      (s.reference ? proof.reference : proof.model).push_back({s.name, s.x, s.y});
    }
    proofs.push_back(std::move(proof));
  }
  if (proofs.empty()) proofs.push_back({report.title, "", "", report.source});
  for (const Bound& b : report.figures) {
    proofs.front().figures.push_back({b.name, b.value, b.limit, b.unit});
  }
  for (const std::string& note : report.notes) {
    proofs.front().note += (proofs.front().note.empty() ? "" : "\n") + note;
  }
  return proofs;
}

}  // namespace whirl::plant
