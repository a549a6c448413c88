#include "io_bridges/qemu/stm32/rcc.hpp"

#include <cmath>

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  CR = 0x00,
  PLLCFGR = 0x04,
  CFGR = 0x08,
  CIR = 0x0C,
  AHB1RSTR = 0x10,
  APB2RSTR = 0x24,
  AHB1ENR = 0x30,
  APB2ENR = 0x44,
  AHB1LPENR = 0x50,
  AHB2LPENR = 0x54,
  AHB3LPENR = 0x58,
  APB1LPENR = 0x60,
  APB2LPENR = 0x64,
  BDCR = 0x70,
  CSR = 0x74,
  SSCGR = 0x80,
  PLLI2SCFGR = 0x84,
};
// CR
constexpr std::uint32_t HSION = 1u << 0, HSIRDY = 1u << 1, HSEON = 1u << 16, HSERDY = 1u << 17,
                        CSSON = 1u << 19, PLLON = 1u << 24, PLLRDY = 1u << 25, PLLI2SON = 1u << 26,
                        PLLI2SRDY = 1u << 27;
constexpr std::uint32_t kCrWritable = 0x050D00F9, kCrReady = HSIRDY | HSERDY | PLLRDY | PLLI2SRDY;
constexpr std::uint32_t PLLSRC = 1u << 22;
// CIR flags, in the order of their bits
constexpr std::uint32_t LSIRDYF = 1u << 0, LSERDYF = 1u << 1, HSIRDYF = 1u << 2, HSERDYF = 1u << 3,
                        PLLRDYF = 1u << 4, PLLI2SRDYF = 1u << 5, CSSF = 1u << 7;
// BDCR, CSR
constexpr std::uint32_t LSEON = 1u << 0, LSERDY = 1u << 1, RTCEN = 1u << 15, BDRST = 1u << 16,
                        RTCSEL = 3u << 8;
constexpr std::uint32_t LSION = 1u << 0, LSIRDY = 1u << 1, RMVF = 1u << 24, BORRSTF = 1u << 25,
                        PINRSTF = 1u << 26, PORRSTF = 1u << 27, SFTRSTF = 1u << 28,
                        IWDGRSTF = 1u << 29, WWDGRSTF = 1u << 30, LPWRRSTF = 1u << 31;

constexpr double kHsi_Hz = 16e6;
constexpr Nanoseconds kHsiStart_ns = 2'200, kHseStart_ns = 2'000'000, kPllLock_ns = 200'000,
                      kLsiStart_ns = 30'000, kLseStart_ns = 2'000'000'000;

enum Source : std::uint32_t { hsi = 0, hse = 1, pll = 2 };

double ahb_divisor(std::uint32_t hpre) {
  static constexpr int kShift[8] = {1, 2, 3, 4, 6, 7, 8, 9};  // there is no /32
  return hpre < 8 ? 1.0 : std::ldexp(1.0, kShift[hpre - 8]);
}
double apb_divisor(std::uint32_t ppre) {
  return ppre < 4 ? 1.0 : std::ldexp(1.0, ppre - 3);
}

std::uint32_t cause_bits(ResetCause cause) {
  switch (cause) {
    case ResetCause::power_on:
      return PORRSTF | PINRSTF | BORRSTF;
    case ResetCause::pin:
      return PINRSTF;
    case ResetCause::software:
      return SFTRSTF | PINRSTF;  // an internal reset pulls NRST too
    case ResetCause::independent_watchdog:
      return IWDGRSTF | PINRSTF;
    case ResetCause::window_watchdog:
      return WWDGRSTF | PINRSTF;
    case ResetCause::low_power:
      return LPWRRSTF | PINRSTF;
  }
  return 0;
}

}  // namespace

Rcc::Rcc(const RccSetup& setup)
    : WordBlock("RCC", Narrow::merge),
      events_(setup.events),
      interrupts_(setup.interrupts),
      finding_(setup.finding),
      hse_Hz_(setup.hse_Hz),
      lse_Hz_(setup.lse_Hz),
      hsi_ready_(events_, [this] { became_ready(CR, HSIRDY, HSIRDYF); }),
      hse_ready_(events_, [this] { became_ready(CR, HSERDY, HSERDYF); }),
      pll_ready_(events_, [this] { became_ready(CR, PLLRDY, PLLRDYF); }),
      plli2s_ready_(events_, [this] { became_ready(CR, PLLI2SRDY, PLLI2SRDYF); }),
      lsi_ready_(events_, [this] { became_ready(CSR, LSIRDY, LSIRDYF); }),
      lse_ready_(events_, [this] { became_ready(BDCR, LSERDY, LSERDYF); }) {
  system_reset(ResetCause::power_on);
}

void Rcc::on_block_reset(std::uint32_t offset, std::uint32_t mask, std::function<void()> reset) {
  reset_lines_.push_back({offset, mask, std::move(reset)});
}

void Rcc::reset() {
  for (io::Event* e : {&hsi_ready_, &hse_ready_, &pll_ready_, &plli2s_ready_}) e->cancel();
  const std::uint32_t backup = word(BDCR), status = word(CSR);
  words_.fill(0);
  word(CR) = 0x8000 | 0x80 | HSION | HSIRDY;  // HSICAL is a factory value
  word(PLLCFGR) = 0x24003010;
  word(AHB1ENR) = 0x00100000;
  word(AHB1LPENR) = 0x7E6791FF;
  word(AHB2LPENR) = 0x000000F1;
  word(AHB3LPENR) = 0x00000001;
  word(APB1LPENR) = 0x36FEC9FF;
  word(APB2LPENR) = 0x00075F33;
  word(PLLI2SCFGR) = 0x20003000;
  word(BDCR) = backup;  // the backup domain outlives a system reset
  word(CSR) = status;
  update_irq();
  update_clocks();
}

void Rcc::system_reset(ResetCause cause) {
  if (cause == ResetCause::power_on) {
    word(BDCR) = 0;
    word(CSR) = 0;
    lse_ready_.cancel();
    lsi_ready_.cancel();
    if (backup_reset_) backup_reset_();
  }
  word(CSR) |= cause_bits(cause);
  reset();
}

std::uint32_t Rcc::read_word(std::uint32_t offset) {
  return offset < words_.size() * 4 ? word(offset) : 0;
}

void Rcc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= words_.size() * 4) return;
  if (offset >= AHB1RSTR && offset <= APB2RSTR) return write_reset_register(offset, value);
  switch (offset) {
    case CR:
      return write_cr(value);
    case CFGR:
      return write_cfgr(value);
    case CIR:
      return write_cir(value);
    case BDCR:
      return write_bdcr(value);
    case CSR:
      return write_csr(value);
    case PLLCFGR:
      if ((word(CR) & PLLON) == 0) word(PLLCFGR) = value & 0x0F437FFF;
      return;
    case PLLI2SCFGR:
      if ((word(CR) & PLLI2SON) == 0) word(PLLI2SCFGR) = value & 0x70007FC0;
      return;
    default:
      word(offset) = value;  // enables, low-power enables, SSCGR: stored
  }
}

// An oscillator was switched on or off. Ready comes after its start-up time.
void Rcc::start(io::Event& ready, Nanoseconds delay, std::uint32_t offset, std::uint32_t on_bit,
                std::uint32_t before, std::uint32_t after, bool fitted) {
  const bool was = (before & on_bit) != 0, is = (after & on_bit) != 0;
  if (was == is) return;
  if (is) {
    if (fitted) ready.in(delay);
    return;
  }
  ready.cancel();
  word(offset) &= ~(on_bit << 1);  // every ready bit sits one above its on bit
}

void Rcc::write_cr(std::uint32_t value) {
  const std::uint32_t before = word(CR);
  std::uint32_t on = value & kCrWritable;
  // What drives SYSCLK cannot be switched off.
  const std::uint32_t sws = (word(CFGR) >> 2) & 3;
  const bool pll_from_hse = (word(PLLCFGR) & PLLSRC) != 0;
  if (sws == pll) on |= PLLON | (pll_from_hse ? HSEON : HSION);
  if (sws == hse) on |= HSEON;
  if (sws == hsi) on |= HSION;
  if ((before & CSSON) != 0) on |= CSSON;  // cleared by reset only (or by the failure itself)
  word(CR) = (before & (kCrReady | 0xFF00)) | on;
  start(hsi_ready_, kHsiStart_ns, CR, HSION, before, on, true);
  start(hse_ready_, kHseStart_ns, CR, HSEON, before, on, hse_Hz_ > 0.0);
  if ((on & ~before & PLLON) != 0) check_limits();
  start(pll_ready_, kPllLock_ns, CR, PLLON, before, on, (word(PLLCFGR) & 0x3F) >= 2);
  start(plli2s_ready_, kPllLock_ns, CR, PLLI2SON, before, on, true);
}

void Rcc::write_cfgr(std::uint32_t value) {
  word(CFGR) = (value & ~0xCu) | (word(CFGR) & 0xC);
  try_switch();
  update_clocks();
}

// SW asks, SWS follows as soon as the wanted source is ready.
void Rcc::try_switch() {
  const std::uint32_t wanted = word(CFGR) & 3;
  static constexpr std::uint32_t kReady[4] = {HSIRDY, HSERDY, PLLRDY, 0};
  if ((word(CR) & kReady[wanted]) == 0) return;
  word(CFGR) = (word(CFGR) & ~0xCu) | (wanted << 2);
}

void Rcc::became_ready(std::uint32_t offset, std::uint32_t ready_bit, std::uint32_t flag) {
  word(offset) |= ready_bit;
  word(CIR) |= flag;
  try_switch();
  update_irq();
  update_clocks();
}

void Rcc::write_cir(std::uint32_t value) {
  const std::uint32_t clear = (value >> 16) & 0xBF;
  word(CIR) = (value & 0x3F00) | (word(CIR) & 0xBF & ~clear);
  if ((clear & CSSF) != 0 && nmi_) nmi_(false);
  update_irq();
}

void Rcc::update_irq() {
  constexpr int kRccIrq = 5;
  interrupts_.set(kRccIrq, ((word(CIR) >> 8) & word(CIR) & 0x3F) != 0);
}

void Rcc::write_bdcr(std::uint32_t value) {
  if (backup_writable_ && !backup_writable_()) return;  // PWR_CR.DBP protects the domain
  const std::uint32_t before = word(BDCR);
  if ((value & BDRST) != 0) {
    word(BDCR) = BDRST;
    lse_ready_.cancel();
    if (backup_reset_ && (before & BDRST) == 0) backup_reset_();
    return update_clocks();
  }
  // RTCSEL can be chosen once; only a backup domain reset frees it.
  const std::uint32_t select = (before & RTCSEL) != 0 ? before & RTCSEL : value & RTCSEL;
  word(BDCR) = (value & (LSEON | 4u | RTCEN)) | select | (before & LSERDY);
  start(lse_ready_, kLseStart_ns, BDCR, LSEON, before, value, lse_Hz_ > 0.0);
  update_clocks();
}

void Rcc::write_csr(std::uint32_t value) {
  const std::uint32_t before = word(CSR);
  std::uint32_t flags = before & 0xFE000000;
  if ((value & RMVF) != 0) flags = 0;
  word(CSR) = flags | (value & LSION) | (before & LSIRDY);
  start(lsi_ready_, kLsiStart_ns, CSR, LSION, before, value, true);
}

void Rcc::write_reset_register(std::uint32_t offset, std::uint32_t value) {
  const std::uint32_t rising = value & ~word(offset);
  word(offset) = value;
  if (rising == 0) return;
  for (const ResetLine& line : reset_lines_) {
    if (line.offset == offset && (line.mask & rising) != 0) line.reset();
  }
}

double Rcc::pll_vco_Hz() const {
  const std::uint32_t cfg = word(PLLCFGR);
  const double source = (cfg & PLLSRC) != 0 ? hse_Hz_ : kHsi_Hz;
  const std::uint32_t m = cfg & 0x3F;
  return m < 2 ? 0.0 : source / m * ((cfg >> 6) & 0x1FF);
}

double Rcc::pll48_Hz() const {
  const std::uint32_t q = (word(PLLCFGR) >> 24) & 0xF;
  return (word(CR) & PLLRDY) != 0 && q >= 2 ? pll_vco_Hz() / q : 0.0;
}

double Rcc::rtc_Hz() const {
  if (!rtc_enabled()) return 0.0;
  switch ((word(BDCR) & RTCSEL) >> 8) {
    case 1:
      return (word(BDCR) & LSERDY) != 0 ? lse_Hz_ : 0.0;
    case 2:
      return (word(CSR) & LSIRDY) != 0 ? lsi_Hz() : 0.0;
    case 3: {
      const std::uint32_t divisor = (word(CFGR) >> 16) & 0x1F;
      return (word(CR) & HSERDY) != 0 && divisor >= 2 ? hse_Hz_ / divisor : 0.0;
    }
    default:
      return 0.0;
  }
}

bool Rcc::rtc_enabled() const {
  return (word(BDCR) & RTCEN) != 0;
}

void Rcc::update_clocks() {
  const std::uint32_t cfgr = word(CFGR);
  const std::uint32_t sws = (cfgr >> 2) & 3;
  const std::uint32_t p = 2 * (((word(PLLCFGR) >> 16) & 3) + 1);
  sysclk_Hz_ = sws == hsi ? kHsi_Hz : sws == hse ? hse_Hz_ : pll_vco_Hz() / p;
  hclk_Hz_ = sysclk_Hz_ / ahb_divisor((cfgr >> 4) & 0xF);
  const double div1 = apb_divisor((cfgr >> 10) & 7), div2 = apb_divisor((cfgr >> 13) & 7);
  pclk1_Hz_ = hclk_Hz_ / div1;
  pclk2_Hz_ = hclk_Hz_ / div2;
  timclk1_Hz_ = div1 > 1.0 ? 2 * pclk1_Hz_ : pclk1_Hz_;
  timclk2_Hz_ = div2 > 1.0 ? 2 * pclk2_Hz_ : pclk2_Hz_;
  if (sysclk_Hz_ > 168.001e6) report_once(1, "SYSCLK above 168 MHz");
  if (pclk1_Hz_ > 42.001e6) report_once(2, "PCLK1 above 42 MHz");
  if (pclk2_Hz_ > 84.001e6) report_once(4, "PCLK2 above 84 MHz");
  for (const auto& listener : listeners_) listener();
}

void Rcc::check_limits() {
  const std::uint32_t cfg = word(PLLCFGR), m = cfg & 0x3F;
  if (m < 2) return report_once(8, "PLLM below 2: the PLL will not lock");
  const double in = ((cfg & PLLSRC) != 0 ? hse_Hz_ : kHsi_Hz) / m;
  if (in < 0.95e6 || in > 2.1e6) report_once(16, "PLL input outside 1 to 2 MHz");
  const double vco = pll_vco_Hz();
  if (vco < 100e6 || vco > 432e6) report_once(32, "PLL VCO outside 100 to 432 MHz");
}

void Rcc::report_once(std::uint32_t bit, const std::string& what) {
  if ((reported_ & bit) != 0 || !finding_) return;
  reported_ |= bit;
  finding_({events_.now(), "RCC", what});
}

void Rcc::fail_hse() {
  hse_ready_.cancel();
  word(CR) &= ~HSERDY;
  const std::uint32_t sws = (word(CFGR) >> 2) & 3;
  const bool pll_on_hse = (word(PLLCFGR) & PLLSRC) != 0;
  const bool lost = sws == hse || (sws == pll && pll_on_hse);
  if (pll_on_hse) word(CR) &= ~(PLLRDY);
  if ((word(CR) & CSSON) == 0) return;  // without CSS the part simply stops; not modelled
  word(CR) &= ~(HSEON | CSSON | (pll_on_hse ? PLLON : 0));
  word(CR) |= HSION | HSIRDY;
  if (lost) word(CFGR) &= ~0xFu;
  word(CIR) |= CSSF;
  update_clocks();
  if (nmi_) nmi_(true);
}

}  // namespace whirl::stm32
