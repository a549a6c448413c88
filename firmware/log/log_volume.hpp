// A log on a card: LOG00001.ULG and so on in the root of a FAT32 volume that is there. Freestanding.
//
//   Method    the file's clusters, in one run, are chained in the FAT before its directory entry names
//             them, with their full size; from then on only data blocks are written. So nothing that
//             the file system needs is in flight while it logs, and one block (the directory's) makes
//             the file appear as a whole. The run is erased first: what was not written yet reads as
//             the card's erased state (zeros), no old log's records. close() sets the true size and
//             gives the rest back
//   Contract  tick() as often as the card's tick(), before it; append() takes whole records or none.
//             A full file is closed and the next one begun. Each file begins empty: what had not been
//             written is dropped and counted; the owner writes its header again when files() changes
//   Power cut at any instant loses what was appended in the last kFlush_us, and what the card itself
//             loses of blocks in programming. fsck.fat -n then says
//               while it logs   nothing: the volume is clean
//               while it opens  "FATs differ" (the first one is right), or clusters that no file has;
//                               free space unknown. No file is touched
//               while it closes the same; and between the two blocks that shorten the file (some ms),
//                               that its chain is longer than its size: the size is the true one
//             The free count in FSInfo is set to unknown, as the specification allows
//   Left out  directories, other files, long names, a root directory that is full and would have to grow
//             (refused), volumes with sectors of other sizes, FAT16, exFAT; the "dirty" bits: without
//             a FAT write in flight there is nothing to repair
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>

#include "firmware/log/fat32.hpp"
#include "firmware/status.hpp"

namespace fw {

template <typename C>
concept BlockCard = requires(C card, std::uint32_t block, fat32::Sector& sector) {
  { card.ready() } -> std::same_as<bool>;
  { card.busy() } -> std::same_as<bool>;
  { card.result() } -> std::same_as<Status>;
  { card.starts() } -> std::same_as<std::uint32_t>;
  { card.read(block, sector) } -> std::same_as<Status>;
  { card.write(block, sector) } -> std::same_as<Status>;
  { card.finish() } -> std::same_as<Status>;
  { card.erase(block, block) } -> std::same_as<Status>;
};

enum class LogState : std::uint8_t {
  no_card,
  opening,
  logging,
  closing,
  closed,
  refused,  // no FAT32 volume, no room, or its root directory is full
};

template <BlockCard Card>
class LogVolume {
 public:
  static constexpr std::uint32_t kFlush_us = 1'000'000;

  // Sizes of a file; where there is no such run of free clusters, the longest that is no less than the least.
  struct Sizes {
    std::uint32_t file_bytes = 32u << 20, least_bytes = 1u << 20;
  };

  // ring: holds what is appended until the card takes it. Not in here, where it would lie in flash as so
  // many zeros beside what is none.
  constexpr LogVolume(Card& card, std::span<std::uint8_t> ring, Sizes sizes = {})
      : card_(card), ring_(ring), sizes_(sizes) {}

  void tick(std::uint32_t now_us);
  // False: dropped and counted; it is not logging, or the buffer is full.
  bool append(std::span<const std::uint8_t> record);
  // Bytes that append() would take now.
  std::size_t room() const { return state() == LogState::logging ? ring_.size() - held_ : 0; }
  void close() { close_wanted_ = true; }
  void open() { close_wanted_ = false; }                           // again, in a new file
  void set_time(std::uint16_t fat_date, std::uint16_t fat_time) {  // of files begun from now on
    date_ = fat_date;
    time_ = fat_time;
  }

  LogState state() const;
  std::uint32_t files() const { return files_; }  // begun
  std::uint32_t number() const { return file_.number; }
  std::uint32_t file_bytes() const { return written_; }  // accepted by the card
  std::uint32_t dropped() const { return dropped_; }     // bytes
  std::uint32_t failures() const { return failures_; }   // of the card, survived

 private:
  enum class Step : std::uint8_t {
    no_card,
    partition,
    boot,
    root,
    root_chain,
    search,
    info,
    info_put,
    chain,
    chain_put,
    erase,
    slot,
    slot_put,  // opening, to here
    logging,
    block_put,
    partial_put,
    flushed,
    size_begin,
    size_read,
    size_put,
    end_chain,
    end_chain_put,
    close_finish,
    closed,
    refused,
  };

  void start_over();
  void begin_search();
  bool ask(std::uint32_t block, Step then);
  bool put(std::uint32_t block, Step then);
  bool wait(Status begun, Step then);
  bool advance(std::uint32_t now_us);
  bool advance_opening();
  bool advance_logging(std::uint32_t now_us);
  bool advance_closing();
  bool scan_root();
  bool next_root_sector();
  bool search();
  bool found();
  bool chain_sector(Step then);
  bool begin_logging(std::uint32_t now_us);
  std::uint32_t chain_value(std::uint32_t cluster) const;
  std::uint32_t fat_sector_of(std::uint32_t cluster) const {
    return cluster / fat32::kEntries_per_sector;
  }
  std::uint32_t cluster_bytes() const { return 512 * volume_.sectors_per_cluster; }
  std::uint32_t run_bytes() const { return run_clusters_ * cluster_bytes(); }
  std::uint32_t log_block() const {
    return volume_.block_of(run_first_) + written_ / fat32::kSector_bytes;
  }
  bool refuse() {
    step_ = Step::refused;
    return false;
  }

  Card& card_;
  std::span<std::uint8_t> ring_;
  Sizes sizes_;
  Step step_ = Step::no_card;
  bool waiting_ = false;  // for the card
  bool close_wanted_ = false;
  std::uint32_t card_starts_ = 0, files_ = 0, failures_ = 0, dropped_ = 0;
  std::uint16_t date_ = 0x0021, time_ = 0;

  fat32::Sector sector_{};
  fat32::Volume volume_{};
  std::uint32_t partition_ = 0;
  std::uint32_t cluster_ = 0, sector_in_cluster_ = 0;  // of the root directory
  std::uint32_t highest_ = 0, slot_block_ = 0, slot_ = 0;
  std::uint32_t free_first_ = 0, free_clusters_ = 0;  // in a row, while searching
  std::uint32_t wanted_clusters_ = 0, run_first_ = 0, run_clusters_ = 0, run_last_ = 0;
  std::uint32_t fat_copy_ = 0, fat_sector_ = 0;  // being searched or written
  fat32::LogFile file_{};
  std::uint32_t written_ = 0;  // whole blocks, in bytes
  std::uint32_t tail_ = 0;     // bytes of the block after them that a flush has put there
  std::uint32_t flushed_us_ = 0;

  std::size_t read_at_ = 0, held_ = 0;
};

}  // namespace fw

#include "firmware/log/log_volume_steps.hpp"
