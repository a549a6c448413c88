// The steps of LogVolume, in the order in which they come; see log_volume.hpp, which includes this.
#pragma once
#include "firmware/log/log_volume.hpp"

namespace fw {

template <BlockCard Card>
LogState LogVolume<Card>::state() const {
  if (step_ == Step::no_card) return LogState::no_card;
  if (step_ <= Step::slot_put) return LogState::opening;
  if (step_ <= Step::flushed) return LogState::logging;
  if (step_ < Step::closed) return LogState::closing;
  return step_ == Step::closed ? LogState::closed : LogState::refused;
}

template <BlockCard Card>
bool LogVolume<Card>::append(std::span<const std::uint8_t> record) {
  if (state() != LogState::logging || held_ + record.size() > ring_.size()) {
    dropped_ += static_cast<std::uint32_t>(record.size());
    return false;
  }
  for (const std::uint8_t byte : record) ring_[(read_at_ + held_++) % ring_.size()] = byte;
  return true;
}

// ---- The card

template <BlockCard Card>
void LogVolume<Card>::start_over() {
  step_ = Step::no_card;
  waiting_ = false;
  dropped_ += static_cast<std::uint32_t>(held_);
  held_ = read_at_ = 0;
}

template <BlockCard Card>
void LogVolume<Card>::tick(std::uint32_t now_us) {
  const bool lost = step_ != Step::no_card && (!card_.ready() || card_.starts() != card_starts_);
  if (lost) {
    ++failures_;
    start_over();
  }
  if (!card_.ready() || card_.busy()) return;
  if (waiting_ && card_.result() != Status::ok) return;  // the card starts anew: lost, next time
  waiting_ = false;
  while (advance(now_us)) {
  }
}

template <BlockCard Card>
bool LogVolume<Card>::wait(Status begun, Step then) {
  if (begun == Status::bad_data) return refuse();  // beyond the card's end
  if (begun != Status::ok) return false;           // tried again at the next tick
  waiting_ = true;
  step_ = then;
  return false;
}

template <BlockCard Card>
bool LogVolume<Card>::ask(std::uint32_t block, Step then) {
  return wait(card_.read(block, sector_), then);
}

template <BlockCard Card>
bool LogVolume<Card>::put(std::uint32_t block, Step then) {
  return wait(card_.write(block, sector_), then);
}

// True: go on at once; false: the card works, or there is nothing to do.
template <BlockCard Card>
bool LogVolume<Card>::advance(std::uint32_t now_us) {
  if (step_ == Step::slot_put) return begin_logging(now_us);
  if (step_ < Step::slot_put) return advance_opening();
  if (step_ <= Step::flushed) return advance_logging(now_us);
  return advance_closing();
}

// ---- Opening

template <BlockCard Card>
bool LogVolume<Card>::advance_opening() {
  using namespace fat32;
  switch (step_) {
    case Step::no_card:
      if (close_wanted_) return false;
      card_starts_ = card_.starts();
      return ask(0, Step::partition);
    case Step::partition:
      partition_ = 0;
      if (read_boot(sector_, 0, volume_)) {
        step_ = Step::boot;
        return true;
      }
      partition_ = partition_of(sector_);
      return partition_ == 0 ? refuse() : ask(partition_, Step::boot);
    case Step::boot:
      if (!read_boot(sector_, partition_, volume_)) return refuse();
      cluster_ = volume_.root;
      sector_in_cluster_ = highest_ = slot_block_ = 0;
      return ask(volume_.block_of(cluster_), Step::root);
    case Step::root:
      return scan_root();
    case Step::root_chain:
      cluster_ = fat_entry(sector_, cluster_);
      sector_in_cluster_ = 0;
      if (cluster_ >= 2 && cluster_ < volume_.end_cluster()) {
        return ask(volume_.block_of(cluster_), Step::root);
      }
      if (slot_block_ == 0) return refuse();
      begin_search();
      return true;
    case Step::search:
      return search();
    case Step::info:
      if (get(sector_, 0, 4) != kInfo_signature || get(sector_, 488, 4) == kUnknown) {
        step_ = Step::info_put;
        return true;
      }
      fat32::put(sector_, 488, 4, kUnknown);
      return put(volume_.info, Step::info_put);
    case Step::info_put:  // the last FAT first, and each from its end: a chain is never without one
      fat_copy_ = volume_.fats - 1;
      fat_sector_ = fat_sector_of(run_last_);
      return ask(volume_.fat + fat_copy_ * volume_.fat_sectors + fat_sector_, Step::chain);
    case Step::chain:
      return chain_sector(Step::chain_put);
    case Step::chain_put:
      if (fat_sector_ > fat_sector_of(run_first_)) {
        --fat_sector_;
      } else if (fat_copy_ > 0) {
        --fat_copy_;
        fat_sector_ = fat_sector_of(run_last_);
      } else {
        const std::uint32_t first = volume_.block_of(run_first_);
        return wait(card_.erase(first, first + run_bytes() / kSector_bytes - 1), Step::erase);
      }
      return ask(volume_.fat + fat_copy_ * volume_.fat_sectors + fat_sector_, Step::chain);
    case Step::erase:
      return ask(slot_block_, Step::slot);
    default:  // slot
      file_ = {highest_ + 1, run_first_, run_bytes(), date_, time_};
      put_log_entry(sector_, slot_, file_);
      return put(slot_block_, Step::slot_put);
  }
}

template <BlockCard Card>
bool LogVolume<Card>::scan_root() {
  for (std::uint32_t slot = 0; slot < fat32::kSlots_per_sector; ++slot) {
    const std::uint8_t first = sector_[32 * slot];
    if ((first == 0x00 || first == 0xE5) && slot_block_ == 0) {
      slot_block_ = volume_.block_of(cluster_) + sector_in_cluster_;
      slot_ = slot;
    }
    if (first == 0x00) {
      begin_search();
      return true;
    }
    highest_ = std::max(highest_, fat32::log_number(sector_, slot));
  }
  return next_root_sector();
}

template <BlockCard Card>
bool LogVolume<Card>::next_root_sector() {
  if (++sector_in_cluster_ < volume_.sectors_per_cluster) {
    return ask(volume_.block_of(cluster_) + sector_in_cluster_, Step::root);
  }
  return ask(volume_.fat + fat_sector_of(cluster_), Step::root_chain);
}

template <BlockCard Card>
void LogVolume<Card>::begin_search() {
  wanted_clusters_ = std::max<std::uint32_t>(1, sizes_.file_bytes / cluster_bytes());
  run_clusters_ = free_clusters_ = fat_sector_ = 0;
  fat_copy_ = 1;  // nothing read yet
  step_ = highest_ >= 99'999 ? Step::refused : Step::search;
}

// One sector of the FAT after another, until there is a run of free clusters of that length; at the end
// of the FAT the longest that was met, if it is worth a file.
template <BlockCard Card>
bool LogVolume<Card>::search() {
  if (fat_copy_ == 1) {
    fat_copy_ = 0;
    return ask(volume_.fat + fat_sector_, Step::search);
  }
  const std::uint32_t first = fat_sector_ * fat32::kEntries_per_sector;
  for (std::uint32_t i = 0; i < fat32::kEntries_per_sector; ++i) {
    const std::uint32_t cluster = first + i;
    const bool within = cluster >= 2 && cluster < volume_.end_cluster();
    if (!within || fat32::fat_entry(sector_, cluster) != 0) {
      free_clusters_ = 0;
      continue;
    }
    if (free_clusters_++ == 0) free_first_ = cluster;
    if (free_clusters_ <= run_clusters_) continue;
    run_first_ = free_first_;
    run_clusters_ = free_clusters_;
    if (run_clusters_ == wanted_clusters_) return found();
  }
  if ((++fat_sector_) * fat32::kEntries_per_sector < volume_.end_cluster()) {
    return ask(volume_.fat + fat_sector_, Step::search);
  }
  return run_clusters_ > 0 && run_bytes() >= sizes_.least_bytes ? found() : refuse();
}

template <BlockCard Card>
bool LogVolume<Card>::found() {
  run_last_ = run_first_ + run_clusters_ - 1;
  if (volume_.info != 0) return ask(volume_.info, Step::info);
  step_ = Step::info_put;
  return true;
}

// What the FAT says of a cluster of the run: the next one, the end after run_last_, free beyond.
template <BlockCard Card>
std::uint32_t LogVolume<Card>::chain_value(std::uint32_t cluster) const {
  if (cluster == run_last_) return fat32::kEnd;
  return cluster < run_last_ ? cluster + 1 : 0;
}

template <BlockCard Card>
bool LogVolume<Card>::chain_sector(Step then) {
  const std::uint32_t first = fat_sector_ * fat32::kEntries_per_sector;
  const std::uint32_t end =
      std::min(first + fat32::kEntries_per_sector, run_first_ + run_clusters_);
  for (std::uint32_t cluster = std::max(first, run_first_); cluster < end; ++cluster) {
    fat32::put_fat_entry(sector_, cluster, chain_value(cluster));
  }
  return put(volume_.fat + fat_copy_ * volume_.fat_sectors + fat_sector_, then);
}

template <BlockCard Card>
bool LogVolume<Card>::begin_logging(std::uint32_t now_us) {
  written_ = tail_ = 0;
  held_ = read_at_ = 0;
  flushed_us_ = now_us;
  ++files_;
  // The directory's block is safe before the first data follow.
  return wait(card_.finish(), Step::logging);
}

// ---- Logging

template <BlockCard Card>
bool LogVolume<Card>::advance_logging(std::uint32_t now_us) {
  if (step_ == Step::block_put) {
    const std::size_t taken = fat32::kSector_bytes;
    read_at_ = (read_at_ + taken) % ring_.size();
    held_ -= taken;
    written_ += static_cast<std::uint32_t>(taken);
    tail_ = 0;
  }
  if (step_ == Step::partial_put) return wait(card_.finish(), Step::flushed);
  step_ = Step::logging;
  const bool full = written_ == run_bytes();
  if (full || (close_wanted_ && held_ == tail_)) {
    step_ = Step::size_begin;
    return true;
  }
  const auto count = static_cast<std::uint32_t>(std::min(held_, fat32::kSector_bytes));
  const bool due = now_us - flushed_us_ >= kFlush_us || close_wanted_;
  if (count < fat32::kSector_bytes && !due) return false;
  if (count == tail_ && count < fat32::kSector_bytes) {  // nothing new in the last block
    flushed_us_ = now_us;
    return wait(card_.finish(), Step::flushed);
  }
  sector_.fill(0);
  for (std::uint32_t i = 0; i < count; ++i) sector_[i] = ring_[(read_at_ + i) % ring_.size()];
  if (count == fat32::kSector_bytes) return put(log_block(), Step::block_put);
  put(log_block(), Step::partial_put);
  tail_ = count;
  flushed_us_ = now_us;
  return false;
}

// ---- Closing

template <BlockCard Card>
bool LogVolume<Card>::advance_closing() {
  switch (step_) {
    case Step::size_begin:
      if (written_ + tail_ == run_bytes()) {  // full: the directory says so already
        step_ = Step::close_finish;
        return true;
      }
      return ask(slot_block_, Step::size_read);
    case Step::size_read: {
      file_.size_bytes = written_ + tail_;
      if (file_.size_bytes == 0) file_.first_cluster = 0;  // FAT's empty file has no cluster
      fat32::put_log_entry(sector_, slot_, file_);
      return put(slot_block_, Step::size_put);
    }
    case Step::size_put: {
      const std::uint32_t used = (file_.size_bytes + cluster_bytes() - 1) / cluster_bytes();
      run_last_ = run_first_ + used - 1;  // before run_first_ when nothing was written: all free
      fat_copy_ = 0;
      fat_sector_ = fat_sector_of(used == 0 ? run_first_ : run_last_);
      return ask(volume_.fat + fat_sector_, Step::end_chain);
    }
    case Step::end_chain:
      return chain_sector(Step::end_chain_put);
    case Step::end_chain_put:
      if (fat_sector_ < fat_sector_of(run_first_ + run_clusters_ - 1)) {
        ++fat_sector_;
      } else if (++fat_copy_ < volume_.fats) {
        fat_sector_ = fat_sector_of(std::max(run_last_, run_first_));
      } else {
        step_ = Step::close_finish;
        return true;
      }
      return ask(volume_.fat + fat_copy_ * volume_.fat_sectors + fat_sector_, Step::end_chain);
    case Step::close_finish:
      return wait(card_.finish(), Step::closed);
    case Step::closed:
      if (close_wanted_) return false;
      start_over();
      return true;
    default:
      return false;
  }
}

}  // namespace fw
