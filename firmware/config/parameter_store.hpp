// The parameters in flash: a power cut at any moment leaves the old set or the new one, never a mix.
//
//   Place     two sectors by turns. A record goes behind the last word that is in use; where it does
//             not fit, into the other sector, which is blank
//   Start     the newest record with a right CRC counts; the sector that it is not in is erased unless
//             it is blank. Never at another time: an erase stalls the core for 0.25 to 0.5 s
//   Write     0.5 s after the last change, a word per call, each read back; the CRC comes last, and
//             until it stands the record before counts
//   Wear      one erase per sector full of records. With all of 50 parameters set that is 39 saves:
//             10,000 erases of each sector are 780,000 saves. Each record carries their number
//   Left out  entries that this image has no row for are gone with its next save
#pragma once
#include <concepts>
#include <cstdint>

#include "firmware/config/parameter_record.hpp"
#include "firmware/status.hpp"

namespace fw {

// Two sectors of kWords words. program() clears bits only and takes up to 0.1 ms.
template <typename F>
concept ParameterFlash = requires(F flash, unsigned sector, std::uint32_t word,
                                  std::uint32_t value) {
  { flash.read(sector, word) } -> std::same_as<std::uint32_t>;
  { flash.program(sector, word, value) } -> std::same_as<Status>;
  { flash.erase(sector) } -> std::same_as<Status>;
  requires F::kWords > ParameterRecord::kMostWords;
};

template <ParameterFlash Flash>
class ParameterStore {
 public:
  static constexpr std::uint32_t kQuiet_calls = 500;
  static constexpr int kTries = 3;

  explicit constexpr ParameterStore(Flash& flash) : flash_(flash) {}

  // Once, at boot, into parameters that are as the table starts them.
  void load(Parameters& parameters);
  // Once per tick, wherever the core may stall for a word.
  void step(const Parameters& parameters);

  // The newest change is not in flash: no room until the next start, or the flash does not hold it.
  bool gave_up(const Parameters& parameters) const { return given_up_ == parameters.changes(); }
  bool saved(const Parameters& parameters) const { return saved_ == parameters.changes(); }
  std::uint32_t generation() const { return generation_; }
  std::uint32_t erases() const { return erases_; }

 private:
  static constexpr std::uint32_t kBlank = 0xFFFF'FFFF, kNone = 0xFFFF'FFFF;

  bool holds_record(unsigned sector, std::uint32_t at);
  std::uint32_t end_of_use(unsigned sector);
  void find_newest(unsigned sector, std::uint32_t& found);
  void make_blank(unsigned sector);
  void begin(const Parameters& parameters);
  void write_next();

  Flash& flash_;
  unsigned sector_ = 0;    // the newest record's
  std::uint32_t end_ = 0;  // of what is in use there
  bool other_blank_ = false;
  std::uint32_t generation_ = 0, erases_ = 0;
  // Counts of Parameters::changes().
  std::uint32_t saved_ = 0, seen_ = 0, writing_ = 0, given_up_ = kNone;
  std::uint32_t quiet_calls_ = 0;
  ParameterRecord record_;  // being written: what changes meanwhile waits for the next
  std::uint32_t next_ = 0;
  int failures_ = 0;
};

template <ParameterFlash Flash>
bool ParameterStore<Flash>::holds_record(unsigned sector, std::uint32_t at) {
  const std::uint32_t words = ParameterRecord::words_of(flash_.read(sector, at));
  if (words == 0 || words > Flash::kWords - at) return false;
  std::uint32_t crc = kCrc32Start;
  for (std::uint32_t i = 0; i + 1 < words; ++i) {
    crc = crc32_add_word(crc, flash_.read(sector, at + i));
  }
  return flash_.read(sector, at + words - 1) == ~crc;
}

template <ParameterFlash Flash>
std::uint32_t ParameterStore<Flash>::end_of_use(unsigned sector) {
  std::uint32_t end = Flash::kWords;
  while (end > 0 && flash_.read(sector, end - 1) == kBlank) --end;
  return end;
}

// Word by word: behind a torn record nothing tells where the next one starts.
template <ParameterFlash Flash>
void ParameterStore<Flash>::find_newest(unsigned sector, std::uint32_t& found) {
  const std::uint32_t end = end_of_use(sector);
  for (std::uint32_t at = 0; at < end; ++at) {
    if (!holds_record(sector, at)) continue;
    const std::uint32_t generation = flash_.read(sector, at + 1);
    if (found != kNone && generation <= generation_) continue;
    found = at;
    sector_ = sector;
    generation_ = generation;
    erases_ = flash_.read(sector, at + 2);
  }
}

template <ParameterFlash Flash>
void ParameterStore<Flash>::make_blank(unsigned sector) {
  other_blank_ = end_of_use(sector) == 0;
  if (other_blank_) return;
  ++erases_;
  other_blank_ = flash_.erase(sector) == Status::ok && end_of_use(sector) == 0;
}

template <ParameterFlash Flash>
void ParameterStore<Flash>::load(Parameters& parameters) {
  std::uint32_t found = kNone;
  find_newest(0, found);
  find_newest(1, found);
  end_ = end_of_use(sector_);
  if (found != kNone) {
    const std::uint32_t words = ParameterRecord::words_of(flash_.read(sector_, found));
    for (std::uint32_t i = ParameterRecord::kHead; i + 1 < words; i += ParameterRecord::kEntry) {
      restore(parameters, flash_.read(sector_, found + i), flash_.read(sector_, found + i + 1));
    }
  }
  saved_ = seen_ = parameters.changes();
  make_blank(1 - sector_);
}

template <ParameterFlash Flash>
void ParameterStore<Flash>::step(const Parameters& parameters) {
  if (next_ < record_.words().size()) return write_next();
  if (saved(parameters) || gave_up(parameters)) return;
  if (seen_ != parameters.changes()) {
    seen_ = parameters.changes();
    quiet_calls_ = 0;
    failures_ = 0;
  }
  if (++quiet_calls_ >= kQuiet_calls) begin(parameters);
}

template <ParameterFlash Flash>
void ParameterStore<Flash>::begin(const Parameters& parameters) {
  writing_ = parameters.changes();
  const ParameterRecord record(parameters, generation_ + 1, erases_);
  if (record.words().size() > Flash::kWords - end_) {
    if (!other_blank_) {
      given_up_ = writing_;
      return;
    }
    sector_ = 1 - sector_;
    end_ = 0;
    other_blank_ = false;
  }
  ++generation_;
  record_ = record;
  next_ = 0;
}

template <ParameterFlash Flash>
void ParameterStore<Flash>::write_next() {
  const std::uint32_t word = record_.words()[next_], at = end_++;
  if (flash_.program(sector_, at, word) != Status::ok || flash_.read(sector_, at) != word) {
    record_ = {};  // torn; what is behind it is tried again
    if (++failures_ == kTries) given_up_ = writing_;
    return;
  }
  if (++next_ < record_.words().size()) return;
  saved_ = writing_;
  failures_ = 0;
}

}  // namespace fw
