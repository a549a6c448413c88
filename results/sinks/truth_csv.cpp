// truth.csv: every signal at every step.
#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <vector>

#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

// A row per millisecond of ten minutes is 150 MB of text: long runs keep every second, third, ... row.
constexpr std::uint64_t kMostRows = 200'000;
constexpr std::size_t kFlush_B = 60'000;

class TruthCsv : public Sink {
 public:
  explicit TruthCsv(const SinkSetup& setup)
      : out_(setup.folder + "/truth.csv"),
        stride_(std::max<std::uint64_t>(1, (setup.rows + kMostRows - 1) / kMostRows)) {
    text_ = "t_s";
    for (const Column& column : setup.head.columns) {
      text_ += "," + column.name + (column.unit_suffix.empty() ? "" : "_" + column.unit_suffix);
    }
    text_ += '\n';
  }

  void on_row(std::int64_t t_ns, std::span<const double> values) override {
    if (row_++ % stride_ != 0) return;
    add(static_cast<double>(t_ns) * 1e-9);
    cells_.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) add(cells_[i], values[i]);
    text_ += '\n';
    if (text_.size() > kFlush_B) flush();
  }

  std::vector<Error> finish() override {
    flush();
    std::vector<Error> lost;
    close(out_, lost);
    return lost;
  }

 private:
  // What a column had last, as text with its comma: two in three stand still from row to row.
  struct Cell {
    std::optional<std::uint64_t> bits;
    std::string text;
  };

  void add(Cell& cell, double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    if (cell.bits != bits) {
      cell.bits = bits;
      const std::size_t from = text_.size();
      text_ += ',';
      add(x);
      cell.text.assign(text_, from);
      return;
    }
    text_ += cell.text;
  }
  // Seven digits: below what any model here resolves, and the same on every machine.
  void add(double x) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::general, 7).ptr;
    text_.append(text, end);
  }
  void flush() {
    out_.write(text_);
    text_.clear();
  }

  OutputFile out_;
  std::string text_;
  std::vector<Cell> cells_;
  std::uint64_t stride_, row_ = 0;
};

}  // namespace

const SinkType kTruth_csv{"csv", "truth.csv", true, make_sink<TruthCsv>};

}  // namespace whirl::results
