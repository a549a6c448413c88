#include "results/flight_log/card_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>

namespace whirl::results {
namespace {

constexpr std::size_t kSector_bytes = 512, kEntry_bytes = 32;
constexpr std::uint32_t kChain_mask = 0x0FFFFFFF, kFirst_cluster = 2;
constexpr std::uint64_t kMost_log_bytes = 256u << 20;  // of one file, that a run copies
using Sector = std::array<std::uint8_t, kSector_bytes>;

class CardVolume {
 public:
  explicit CardVolume(const std::string& path) : path_(path), in_(path, std::ios::binary) {}

  Result<Done> open() {
    Sector sector{};
    if (!read(0, sector)) return wrong("cannot be read");
    if (!is_boot(sector)) {
      first_ = partition(sector);
      if (first_ == 0 || !read(first_, sector) || !is_boot(sector)) {
        return wrong("has no FAT32 volume");
      }
    }
    per_cluster_ = sector[13];
    const std::uint64_t reserved = number(sector, 14, 2), fat_sectors = number(sector, 36, 4);
    root_ = static_cast<std::uint32_t>(number(sector, 44, 4));
    fat_ = first_ + reserved;
    data_ = fat_ + sector[16] * fat_sectors;
    clusters_end_ = static_cast<std::uint32_t>(fat_sectors * (kSector_bytes / 4));
    if (per_cluster_ == 0 || !inside(root_)) return wrong("has a boot sector of no FAT32 volume");
    return Done{};
  }

  Result<std::vector<CardFile>> logs() {
    std::vector<std::uint8_t> root;
    if (auto whole = follow(root_, UINT64_MAX, root); !whole) return whole.error();
    std::vector<CardFile> files;
    for (std::size_t at = 0; at + kEntry_bytes <= root.size() && root[at] != 0;
         at += kEntry_bytes) {
      const std::string name(root.begin() + static_cast<std::ptrdiff_t>(at),
                             root.begin() + static_cast<std::ptrdiff_t>(at) + 11);
      constexpr std::uint8_t kLabel_or_folder = 0x18;
      const bool is_log = name.starts_with("LOG") && name.ends_with("ULG");
      if (!is_log || (root[at + 11] & kLabel_or_folder) != 0) continue;
      const auto cluster =
          static_cast<std::uint32_t>(number(root, at + 20, 2) << 16 | number(root, at + 26, 2));
      const std::uint64_t size = number(root, at + 28, 4);
      if (size > kMost_log_bytes) return wrong(name + " is larger than any log");
      CardFile file{name.substr(0, 8) + "." + name.substr(8), {}};
      if (size > 0) {
        if (auto whole = follow(cluster, size, file.bytes); !whole) return whole.error();
      }
      files.push_back(std::move(file));
    }
    std::sort(files.begin(), files.end(),
              [](const CardFile& a, const CardFile& b) { return a.name < b.name; });
    return files;
  }

 private:
  template <typename Bytes>
  static std::uint64_t number(const Bytes& from, std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | from[at + i];
    return value;
  }
  static bool is_boot(const Sector& s) {
    return number(s, 510, 2) == 0xAA55 && number(s, 11, 2) == kSector_bytes &&
           number(s, 22, 2) == 0 && number(s, 36, 4) != 0;
  }
  static std::uint64_t partition(const Sector& s) {
    for (std::size_t at = 446; at < 510; at += 16) {
      if (s[at + 4] == 0x0B || s[at + 4] == 0x0C) return number(s, at + 8, 4);
    }
    return 0;
  }
  bool inside(std::uint32_t cluster) const {
    return cluster >= kFirst_cluster && cluster < clusters_end_;
  }
  bool read(std::uint64_t sector, std::span<std::uint8_t> into) {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(sector * kSector_bytes));
    in_.read(reinterpret_cast<char*>(into.data()),  // NOLINT: bytes are bytes
             static_cast<std::streamsize>(into.size()));
    return in_.good();
  }
  Error wrong(const std::string& what) const { return {ErrorKind::bad_input, path_, what, ""}; }

  // The chain from that cluster on, as far as `size` goes.
  Result<Done> follow(std::uint32_t cluster, std::uint64_t size, std::vector<std::uint8_t>& bytes) {
    Sector fat{};
    std::uint64_t held = 0;  // sector of the FAT
    for (std::uint32_t steps = 0; inside(cluster) && bytes.size() < size; ++steps) {
      if (steps > clusters_end_) return wrong("has a chain of clusters in a circle");
      const std::size_t before = bytes.size();
      bytes.resize(before + per_cluster_ * kSector_bytes);
      const std::uint64_t sector = data_ + std::uint64_t{cluster - kFirst_cluster} * per_cluster_;
      if (!read(sector, std::span(bytes).subspan(before))) return wrong("ends within a file");
      const std::uint64_t wanted = fat_ + cluster / (kSector_bytes / 4);
      if (held != wanted && !read(wanted, fat)) return wrong("ends within its FAT");
      held = wanted;
      cluster = static_cast<std::uint32_t>(number(fat, 4 * (cluster % (kSector_bytes / 4)), 4)) &
                kChain_mask;
    }
    if (bytes.size() > size) bytes.resize(size);
    return Done{};
  }

  std::string path_;
  std::ifstream in_;
  std::uint64_t first_ = 0, fat_ = 0, data_ = 0;
  std::uint32_t root_ = 0, clusters_end_ = 0;
  std::size_t per_cluster_ = 0;
};

}  // namespace

Result<std::vector<CardFile>> logs_on_card(const std::string& image_path) {
  CardVolume volume(image_path);
  if (auto opened = volume.open(); !opened) return opened.error();
  return volume.logs();
}

}  // namespace whirl::results
