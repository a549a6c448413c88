#include "harness/catalogue/calibration_file.hpp"

#include <algorithm>

namespace whirl::catalogue {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;
const std::vector<double> kStill = {0.16, 0.20, 0.25, 0.30, 0.33, 0.36,
                                    0.39, 0.42, 0.45, 0.48, 0.52, 0.60};
const std::vector<double> kBlown = {0.33, 0.38, 0.43, 0.48};
const std::vector<double> kWinds_mps = {0.8, 1.5, 2.3, 3.3, 4.2, 5.0};

std::vector<double> duties(const lua::Table& t, const char* key, std::size_t fewest) {
  auto values = t.quantities(key, Dimension::ratio, lua::between(0.05, 1.0));
  if (!std::is_sorted(values.begin(), values.end()) || values.size() < fewest) {
    t.refuse(key, std::to_string(fewest) + " duties or more, rising, are wanted");
    values.resize(fewest);
  }
  return values;
}

}  // namespace

Result<CalibrationFile> read_calibration(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  calibrate::Setup s;
  s.file = path;
  std::ignore = t.choice("kind", {"calibration"});
  s.image = t.text_or("image", "esc");
  s.board = t.text_or("board", "esc32v2");
  const lua::Table stand = t.table("stand");
  s.serial = static_cast<std::uint16_t>(stand.integer_or("serial", 1, 1, 8));
  s.diameter_m = t.quantity("diameter", Dimension::length, lua::between(0.02, 3.0));
  s.density_kgpm3 =
      t.quantity_or("density", Dimension::density, s.density_kgpm3, lua::between(0.3, 2.0));
  s.still = t.has("still") ? duties(t, "still", 4) : kStill;
  s.blown = t.has("blown") ? duties(t, "blown", 3) : kBlown;
  if (t.has("transient")) {
    const auto pair = duties(t, "transient", 2);
    s.low_duty = pair.front();
    s.high_duty = pair.back();
  }
  s.winds_mps = t.has("winds") ? t.quantities("winds", Dimension::speed, lua::between(0.1, 15.0))
                               : kWinds_mps;
  s.updraft_mps =
      t.quantity_or("updraft", Dimension::speed, s.updraft_mps, lua::between(0.0, 10.0));
  s.air_within =
      t.quantity_or("air_within", Dimension::ratio, s.air_within, lua::between(0.0, 0.3));
  s.warm_up_ms = t.duration_ns_or("warm_up", 0) / kMs_ns;
  s.settle_ms = t.duration_ns_or("settle", s.settle_ms * kMs_ns) / kMs_ns;
  s.measure_ms = t.duration_ns_or("measure", s.measure_ms * kMs_ns) / kMs_ns;
  s.tell_motor = t.flag_or("tell_motor", false);
  s.seed = static_cast<std::uint64_t>(t.integer_or("seed", 1, 0));
  if (const auto good = t.finish_except({"stand"}); !good) return good.error();
  return CalibrationFile{std::move(s), stand};
}

double density_of(const calibrate::Setup& setup, const stand::StandParams& stand) {
  return stand.air ? stand.air->density_kgpm3 : setup.density_kgpm3;
}

}  // namespace whirl::catalogue
