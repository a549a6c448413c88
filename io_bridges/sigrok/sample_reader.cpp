#include "io_bridges/sigrok/sample_reader.hpp"

#include <cmath>
#include <cstring>

namespace whirl::sigrok {
namespace {

bool level(std::span<const std::uint8_t> sample, int bit) {
  const auto byte = static_cast<std::size_t>(bit) / 8;
  return byte < sample.size() && (sample[byte] >> (bit % 8) & 1) != 0;
}

}  // namespace

std::int64_t SampleReader::now_ns() const {
  return std::llround(static_cast<double>(samples_) * (1e9 / rate_Hz_));
}

void SampleReader::compare(std::span<const std::uint8_t> sample) {
  const bool first = last_.empty();
  for (std::size_t wire = 0; wire < bits_.size(); ++wire) {
    const bool now = level(sample, bits_[wire]);
    if (!first && now == level(last_, bits_[wire])) continue;
    sink_.on_edge({now_ns(), static_cast<std::uint16_t>(wire), now});
  }
  last_.assign(sample.begin(), sample.end());
}

void SampleReader::add(std::span<const std::uint8_t> data, std::size_t unit) {
  for (std::size_t at = 0; at + unit <= data.size(); at += unit, ++samples_) {
    const auto sample = data.subspan(at, unit);
    // Most samples are as the one before.
    if (last_.size() == unit && std::memcmp(last_.data(), sample.data(), unit) == 0) continue;
    compare(sample);
  }
  sink_.advance_to(now_ns());
}

}  // namespace whirl::sigrok
