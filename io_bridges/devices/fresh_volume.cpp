#include "io_bridges/devices/fresh_volume.hpp"

#include <array>
#include <cstring>
#include <string_view>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr std::int64_t kSector_bytes = 512;
constexpr std::int64_t kPartition_sector = 2048;
constexpr std::int64_t kReserved_sectors = 32;
constexpr std::int64_t kInfo_sector = 1, kBackup_sector = 6;
constexpr std::uint32_t kRoot_cluster = 2;
constexpr std::uint32_t kEnd_of_chain = 0x0FFFFFFF;

using Sector = std::array<std::uint8_t, kSector_bytes>;

void put(Sector& sector, std::size_t at, std::size_t bytes, std::uint64_t value) {
  for (std::size_t i = 0; i < bytes; ++i, value >>= 8) {
    sector[at + i] = static_cast<std::uint8_t>(value & 0xFF);
  }
}
void put(Sector& sector, std::size_t at, std::string_view text) {
  std::memcpy(&sector[at], text.data(), text.size());
}

struct Layout {
  std::int64_t sectors, sectors_per_cluster, fat_sectors, clusters;
};

Layout layout_of(std::int64_t size_bytes) {
  Layout l{};
  l.sectors = size_bytes / kSector_bytes - kPartition_sector;
  const std::int64_t MiB = size_bytes >> 20;
  l.sectors_per_cluster = MiB <= 260 ? 1 : MiB <= 8192 ? 8 : 64;
  // A FAT sector has 128 entries: each cluster takes its sectors and 2 x 4 bytes.
  const std::int64_t room = l.sectors - kReserved_sectors;
  const std::int64_t per_fat_sector = 128 * l.sectors_per_cluster + 2;
  l.fat_sectors = (room + 2 * l.sectors_per_cluster + per_fat_sector - 1) / per_fat_sector;
  l.clusters = (room - 2 * l.fat_sectors) / l.sectors_per_cluster;
  return l;
}

Sector partition_table(const Layout& l) {
  Sector s{};
  put(s, 446 + 1, 3, 0xFFFFFE);  // no cylinders: LBA only
  s[446 + 4] = 0x0C;             // FAT32 by LBA
  put(s, 446 + 5, 3, 0xFFFFFE);
  put(s, 446 + 8, 4, static_cast<std::uint64_t>(kPartition_sector));
  put(s, 446 + 12, 4, static_cast<std::uint64_t>(l.sectors));
  put(s, 510, 2, 0xAA55);
  return s;
}

Sector boot_sector(const Layout& l, std::uint32_t serial) {
  Sector s{};
  put(s, 0, 3, 0x9058EB);  // jump over the parameters
  put(s, 3, "WHIRL   ");
  put(s, 11, 2, kSector_bytes);
  put(s, 13, 1, static_cast<std::uint64_t>(l.sectors_per_cluster));
  put(s, 14, 2, kReserved_sectors);
  put(s, 16, 1, 2);     // FATs
  put(s, 21, 1, 0xF8);  // fixed medium
  put(s, 24, 2, 63);    // sectors and heads of no meaning
  put(s, 26, 2, 255);
  put(s, 28, 4, static_cast<std::uint64_t>(kPartition_sector));
  put(s, 32, 4, static_cast<std::uint64_t>(l.sectors));
  put(s, 36, 4, static_cast<std::uint64_t>(l.fat_sectors));
  put(s, 44, 4, kRoot_cluster);
  put(s, 48, 2, kInfo_sector);
  put(s, 50, 2, kBackup_sector);
  put(s, 64, 1, 0x80);
  put(s, 66, 1, 0x29);
  put(s, 67, 4, serial);
  put(s, 71, "NO NAME    FAT32   ");
  put(s, 510, 2, 0xAA55);
  return s;
}

Sector info_sector(const Layout& l) {
  Sector s{};
  put(s, 0, "RRaA");
  put(s, 484, "rrAa");
  put(s, 488, 4, static_cast<std::uint64_t>(l.clusters - 1));  // free: all but the root directory
  put(s, 492, 4, kRoot_cluster + 1);
  put(s, 510, 2, 0xAA55);
  return s;
}

}  // namespace

void write_fresh_volume(MemoryFile& memory, std::uint32_t serial) {
  WHIRL_CHECK(memory.size_bytes() >= kLeast_volume_bytes, memory.size_bytes());
  WHIRL_CHECK(memory.size_bytes() <= 1LL << 41, memory.size_bytes());
  const Layout l = layout_of(memory.size_bytes());
  const auto write = [&memory](std::int64_t sector, const Sector& bytes) {
    memory.write(sector * kSector_bytes, bytes);
  };
  write(0, partition_table(l));
  for (const std::int64_t copy : {std::int64_t{0}, kBackup_sector}) {
    write(kPartition_sector + copy, boot_sector(l, serial));
    write(kPartition_sector + copy + kInfo_sector, info_sector(l));
  }
  Sector fat{};
  put(fat, 0, 4, 0x0FFFFFF8);     // medium
  put(fat, 4, 4, kEnd_of_chain);  // clean, no errors
  put(fat, 8, 4, kEnd_of_chain);  // root directory
  for (std::int64_t copy = 0; copy < 2; ++copy) {
    write(kPartition_sector + kReserved_sectors + copy * l.fat_sectors, fat);
  }
}

void fill_fresh_volume(MemoryFile& memory, std::int64_t free_bytes) {
  WHIRL_CHECK(memory.size_bytes() <= kMost_filled_bytes, memory.size_bytes());
  constexpr std::int64_t kEntries = kSector_bytes / 4, kFirst = kRoot_cluster + 1;
  const Layout l = layout_of(memory.size_bytes());
  const std::int64_t cluster_bytes = l.sectors_per_cluster * kSector_bytes;
  const std::int64_t left = (free_bytes + cluster_bytes - 1) / cluster_bytes;
  const std::int64_t taken = l.clusters - 1 - left;  // the root directory has one
  if (taken <= 0) return;
  const std::int64_t fat_at = kPartition_sector + kReserved_sectors;
  Sector sector{};
  for (std::int64_t first = 0; first < kFirst + taken; first += kEntries) {
    memory.read((fat_at + first / kEntries) * kSector_bytes, sector);
    for (std::int64_t i = 0; i < kEntries; ++i) {
      const std::int64_t cluster = first + i;
      if (cluster < kFirst || cluster >= kFirst + taken) continue;
      const bool is_last = cluster == kFirst + taken - 1;
      put(sector, static_cast<std::size_t>(4 * i), 4,
          is_last ? kEnd_of_chain : static_cast<std::uint64_t>(cluster + 1));
    }
    for (std::int64_t copy = 0; copy < 2; ++copy) {
      memory.write((fat_at + copy * l.fat_sectors + first / kEntries) * kSector_bytes, sector);
    }
  }
  Sector root{};
  put(root, 0, "FULL    BIN ");  // the blank is 0x20: an archive's attribute
  put(root, 18, 2, 0x0021);      // 1980-01-01
  put(root, 24, 2, 0x0021);
  put(root, 26, 2, kFirst);
  put(root, 28, 4, static_cast<std::uint64_t>(taken * cluster_bytes));
  memory.write((fat_at + 2 * l.fat_sectors) * kSector_bytes, root);
  for (const std::int64_t copy : {std::int64_t{0}, kBackup_sector}) {
    const std::int64_t at = (kPartition_sector + copy + kInfo_sector) * kSector_bytes;
    memory.read(at, sector);
    put(sector, 488, 4, static_cast<std::uint64_t>(left));
    put(sector, 492, 4, static_cast<std::uint64_t>(kFirst + taken));
    memory.write(at, sector);
  }
}

}  // namespace whirl::io
