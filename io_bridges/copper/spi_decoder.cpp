#include "io_bridges/copper/spi_decoder.hpp"

namespace whirl::copper {

void SpiDecoder::select(bool level, std::int64_t t_ns) {
  if (!level) {
    selected_ = true;
    now_ = {};
    now_.start_ns = t_ns;
    clocks_ = 0;
    return;
  }
  if (!selected_) return;
  selected_ = false;
  now_.stop_ns = t_ns;
  if (clocks_ == 0) return;  // selected, and nothing said
  if (clocks_ % 8 == 0) return frame_(now_);
  unread_({now_.start_ns, t_ns,
           std::to_string(clocks_) + " clocks within a select are no multiple of eight"});
}

void SpiDecoder::sck(bool level, std::int64_t t_ns) {
  if (level == sck_) return;
  sck_ = level;
  if (!level || !selected_) return;
  out_ = static_cast<std::uint8_t>(out_ << 1 | (mosi_ ? 1 : 0));
  in_ = static_cast<std::uint8_t>(in_ << 1 | (miso_ ? 1 : 0));
  const std::int64_t clock_ns = t_ns - rise_ns_;
  rise_ns_ = t_ns;
  if (++clocks_ % 8 != 0) return;
  now_.pairs.push_back(out_);
  now_.pairs.push_back(in_);
  now_.passed_ns.push_back(t_ns + clock_ns / 2);
}

}  // namespace whirl::copper
