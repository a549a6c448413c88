#include "firmware/esc/image/settings.hpp"

#include <cstring>

#include "firmware/esc/image/registers.hpp"
#include "firmware/esc/image/settings_page.hpp"

namespace fw::esc::settings {
namespace {

using namespace f103;

std::uint32_t crc_of(const Stored& stored) {
  const auto* bytes = static_cast<const char*>(static_cast<const void*>(&stored));
  return crc32_of({bytes, sizeof stored - sizeof stored.crc});
}

bool wait_done() {
  while (FLASH::SR::has(FLASH::BSY)) {
  }
  const bool good = (FLASH::SR::read() & (FLASH::PGERR | FLASH::WRPRTERR)) == 0;
  FLASH::SR::write(FLASH::EOP | FLASH::PGERR | FLASH::WRPRTERR);
  return good;
}

bool erase() {
  FLASH::CR::write(FLASH::PER);
  FLASH::AR::write(kPage);
  FLASH::CR::write(FLASH::PER | FLASH::STRT);
  return wait_done();
}

bool program(const Stored& stored) {
  auto* cell = reinterpret_cast<volatile std::uint16_t*>(kPage);  // NOLINT: flash takes half-words
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&stored);  // NOLINT
  FLASH::CR::write(FLASH::PG);
  bool good = true;
  for (std::uint32_t i = 0; good && i < sizeof stored; i += 2) {
    *cell++ = static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8);
    good = wait_done();
  }
  return good;
}

}  // namespace

bool load(Settings& settings) {
  Stored stored;
  std::memcpy(&stored, reinterpret_cast<const void*>(kPage), sizeof stored);  // NOLINT
  if (stored.magic != kMagic || stored.size != sizeof stored || stored.crc != crc_of(stored)) {
    return false;
  }
  settings = stored.settings;
  return true;
}

bool save(const Settings& settings) {
  Stored stored;
  std::memset(static_cast<void*>(&stored), 0, sizeof stored);  // padding takes part in the CRC
  stored.magic = kMagic;
  stored.size = sizeof stored;
  stored.settings = settings;
  stored.crc = crc_of(stored);
  FLASH::KEYR::write(FLASH::KEY1);
  FLASH::KEYR::write(FLASH::KEY2);
  const bool good = erase() && program(stored);
  FLASH::CR::write(FLASH::LOCK);
  return good &&
         std::memcmp(reinterpret_cast<const void*>(kPage), &stored, sizeof stored) == 0;  // NOLINT
}

}  // namespace fw::esc::settings
