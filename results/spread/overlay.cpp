#include "results/spread/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "results/messages/message_file.hpp"
#include "results/sinks/replay.hpp"
#include "results/spread/same_expectation.hpp"

namespace whirl::results {
namespace {

constexpr std::size_t kPoints = 300;
constexpr double kShortest_s = 0.1;

struct Window {
  std::string key;  // the expectation's, and the signal
  std::string signal;
  double from_s = 0, to_s = 0;
  std::vector<double> limits_SI;  // of a level
};

struct Stretch {
  double sum = 0;
  std::size_t n = 0;
};

struct Recorded {
  std::string unit;
  double step_s = 0;  // from point to point
  std::vector<double> values;
};

// Windows of one run; of several expectations about one signal in one time the first.
std::vector<Window> windows_of(const Report& report) {
  std::vector<Window> all;
  std::map<std::tuple<std::string, double, double>, std::size_t> seen;
  SameExpectation names;
  for (const Expectation& e : report.expectations) {
    const std::string name = names.name(e);
    if (e.to_s - e.from_s < kShortest_s) continue;
    for (const std::string& signal : e.signals) {
      const auto [at, is_new] = seen.emplace(std::tuple(signal, e.from_s, e.to_s), all.size());
      if (is_new) all.push_back({signal + ": " + name, signal, e.from_s, e.to_s, {}});
      auto& limits = all[at->second].limits_SI;
      if (e.level) limits.insert(limits.end(), e.limits_SI.begin(), e.limits_SI.end());
    }
  }
  return all;
}

class WindowSink : public Sink {
 public:
  WindowSink(const std::vector<Window>& windows, const std::vector<Column>& columns) {
    for (const Window& window : windows) {
      const auto at = std::find_if(columns.begin(), columns.end(),
                                   [&](const Column& c) { return c.name == window.signal; });
      if (at == columns.end()) continue;
      open_.push_back({&window, static_cast<std::size_t>(at - columns.begin()), at->unit,
                       std::vector<Stretch>(kPoints)});
    }
  }

  void on_row(std::int64_t t_ns, std::span<const double> values) override {
    const double t_s = 1e-9 * static_cast<double>(t_ns);
    for (Open& o : open_) {
      const double length_s = o.window->to_s - o.window->from_s;
      const double place = (t_s - o.window->from_s) / length_s * static_cast<double>(kPoints);
      if (place < 0.0 || place >= static_cast<double>(kPoints)) continue;
      Stretch& stretch = o.stretches[static_cast<std::size_t>(place)];
      stretch.sum += values[o.column];
      ++stretch.n;
    }
  }
  std::vector<Error> finish() override { return {}; }

  void give(std::map<std::string, std::vector<Recorded>>& all) const {
    for (const Open& o : open_) {
      Recorded r{o.unit, (o.window->to_s - o.window->from_s) / static_cast<double>(kPoints), {}};
      for (const Stretch& s : o.stretches) {
        r.values.push_back(s.n > 0 ? s.sum / static_cast<double>(s.n) : std::nan(""));
      }
      all[o.window->key].push_back(std::move(r));
    }
  }

 private:
  struct Open {
    const Window* window;
    std::size_t column;
    std::string unit;
    std::vector<Stretch> stretches;
  };
  std::vector<Open> open_;
};

ChartCurve curve(const std::string& name, double step_s, std::vector<double> y, bool faint) {
  std::vector<double> x(y.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = (static_cast<double>(i) + 0.5) * step_s;
  return {name, std::move(x), std::move(y), false, faint};
}

// The mean of all runs and one standard deviation above and below it, where all have a value.
struct Middle {
  std::vector<double> mean, above, below;
};

Middle middle_of(const std::vector<Recorded>& runs) {
  Middle m;
  const auto n = static_cast<double>(runs.size());
  for (std::size_t i = 0; i < kPoints; ++i) {
    double sum = 0, squares = 0;
    for (const Recorded& r : runs) sum += r.values[i];
    const double mean = sum / n;
    for (const Recorded& r : runs) squares += (r.values[i] - mean) * (r.values[i] - mean);
    const double sigma = std::sqrt(squares / (n - 1.0));
    m.mean.push_back(mean);
    m.above.push_back(mean + sigma);
    m.below.push_back(mean - sigma);
  }
  return m;
}

Chart chart_of(const Window& window, std::vector<Recorded> runs) {
  // Windows that end when something happened: each run's own length, as far as all go.
  double step_s = runs.front().step_s;
  for (const Recorded& r : runs) step_s = std::min(step_s, r.step_s);
  for (Recorded& r : runs) {
    std::vector<double> values(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double place = (static_cast<double>(i) + 0.5) * step_s / r.step_s;
      values[i] = r.values[std::min(static_cast<std::size_t>(place), kPoints - 1)];
    }
    r.values = std::move(values);
  }
  const std::string unit = runs.front().unit;
  Chart chart{
      "What was recorded", window.key, "s", unit.empty() ? window.signal : unit, "", "", {}, {}};
  for (const Recorded& r : runs) chart.curves.push_back(curve("", step_s, r.values, true));
  if (runs.size() > 1) {
    Middle m = middle_of(runs);
    chart.curves.push_back(curve("mean", step_s, std::move(m.mean), false));
    chart.curves.push_back(curve("+1 sigma", step_s, std::move(m.above), false));
    chart.curves.push_back(curve("-1 sigma", step_s, std::move(m.below), false));
  }
  for (const double limit : window.limits_SI) {
    const bool is_first = limit == window.limits_SI.front();
    chart.curves.push_back(
        curve(is_first ? "limit" : "", step_s, std::vector<double>(kPoints, limit), false));
  }
  return chart;
}

Result<Done> gather(const SeedRun& run, const std::vector<Window>& windows,
                    std::map<std::string, std::vector<Recorded>>& all) {
  const std::string messages = run.folder + "/messages.whirl";
  const auto reader = MessageReader::open(messages);
  if (!reader) return reader.error();
  WindowSink sink(windows, reader.value().head().columns);
  const auto done = replay(messages, run.folder, {}, {&sink});
  if (!done) return done.error();
  sink.give(all);
  return Done{};
}

}  // namespace

Result<std::vector<Chart>> overlays(const std::vector<const SeedRun*>& runs) {
  std::map<std::string, std::vector<Recorded>> recorded;
  std::vector<Window> windows;
  for (const SeedRun* run : runs) {
    if (run->folder.empty()) continue;
    std::vector<Window> of_run = windows_of(run->report);
    if (const auto read = gather(*run, of_run, recorded); !read) return read.error();
    for (Window& window : of_run) {
      const bool known = std::any_of(windows.begin(), windows.end(),
                                     [&](const Window& w) { return w.key == window.key; });
      if (!known && windows.size() < kMost_overlays) windows.push_back(std::move(window));
    }
  }
  std::vector<Chart> charts;
  for (const Window& window : windows) {
    const auto at = recorded.find(window.key);
    if (at != recorded.end()) charts.push_back(chart_of(window, std::move(at->second)));
  }
  return charts;
}

}  // namespace whirl::results
