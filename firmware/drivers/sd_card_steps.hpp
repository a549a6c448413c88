// What SdCard does at each step; see sd_card.hpp, which includes this.
#pragma once
#include "firmware/drivers/sd_card.hpp"

namespace fw {

// ---- Requests

template <CardSpi Bus>
Status SdCard<Bus>::ask(Request request, std::uint32_t block, std::uint32_t last) {
  if (!ready()) return Status::no_answer;
  if (busy()) return Status::busy;
  if (block >= blocks_ || last >= blocks_) return Status::bad_data;
  request_ = request;
  block_ = block;
  last_ = last;
  return Status::ok;
}

template <CardSpi Bus>
Status SdCard<Bus>::read(std::uint32_t block, Block into) {
  const Status asked = ask(Request::read, block);
  if (asked == Status::ok) into_ = into.data();
  return asked;
}

template <CardSpi Bus>
Status SdCard<Bus>::write(std::uint32_t block, ConstBlock bytes) {
  const Status asked = ask(Request::write, block);
  if (asked == Status::ok) std::copy(bytes.begin(), bytes.end(), outgoing_.begin());
  return asked;
}

template <CardSpi Bus>
Status SdCard<Bus>::finish() {
  return ask(Request::finish, 0);
}

template <CardSpi Bus>
Status SdCard<Bus>::erase(std::uint32_t first, std::uint32_t last) {
  return ask(Request::erase, first, last);
}

// ---- The bus

template <CardSpi Bus>
void SdCard<Bus>::tick(std::uint32_t now_us) {
  std::size_t moved = 0;
  while (bus_.done()) {
    if (in_flight_) {
      in_flight_ = false;
      completed(now_us);
    }
    if (moved + sd::kFrame_bytes > kMost_bytes_per_tick && moved > 0) return;
    begin(now_us);
    if (!in_flight_) return;
    moved += length_;
  }
}

template <CardSpi Bus>
void SdCard<Bus>::exchange(std::size_t bytes) {
  length_ = bytes;
  const bool fast = phase_ >= Phase::idle;
  in_flight_ = bus_.start(std::span(bytes_).first(bytes), fast) == Status::ok;
}

template <CardSpi Bus>
void SdCard<Bus>::command(std::uint8_t index, std::uint32_t argument) {
  exchange(sd::put_command(bytes_, index, argument));
}

template <CardSpi Bus>
void SdCard<Bus>::next_request() {
  const bool goes_on = request_ == Request::write && streaming_ && block_ == next_block_;
  if (request_ == Request::none) return;
  if (streaming_ && !goes_on)
    phase_ = Phase::stop;
  else if (goes_on)
    phase_ = Phase::write_data;
  else if (request_ == Request::read)
    phase_ = Phase::read_command;
  else if (request_ == Request::write)
    phase_ = Phase::write_command;
  else if (request_ == Request::erase)
    phase_ = Phase::erase_first;
  else
    phase_ = Phase::verify;
}

// The next exchange of this phase.
template <CardSpi Bus>
void SdCard<Bus>::begin(std::uint32_t now_us) {
  if (phase_ == Phase::idle) next_request();
  switch (phase_) {
    case Phase::absent:
      if (late(now_us, kRetry_us)) go(Phase::clocks, now_us);
      return;
    case Phase::clocks:
      bus_.select(false);
      return exchange(sd::put_clocks(bytes_, 10));
    case Phase::go_idle:
      bus_.select(true);
      return command(0, 0);
    case Phase::interface:
      return command(8, 0x1AA);
    case Phase::crc_on:
      return command(59, 1);
    case Phase::application:
      return command(55, 0);
    case Phase::operating:
      return command(41, version_2_ ? 1u << 30 : 0);
    case Phase::capacity:
      return command(58, 0);
    case Phase::block_length:
      return command(16, kBlock_bytes);
    case Phase::csd:
      return command(9, 0);
    case Phase::csd_data:
    case Phase::read_data:
      return exchange(sd::put_clocks(bytes_, reader_.wanted()));
    case Phase::read_command:
      return command(17, address(block_));
    case Phase::write_command:
      return command(25, address(block_));
    case Phase::write_data:
      return exchange(sd::put_block(bytes_, outgoing_));
    case Phase::write_busy:
    case Phase::stop_busy:
    case Phase::erase_busy:
      return exchange(sd::put_clocks(bytes_, 8));
    case Phase::stop:
      return exchange(sd::put_stop(bytes_));
    case Phase::status:
    case Phase::verify:
      return command(13, 0);
    case Phase::erase_first:
      return command(32, address(block_));
    case Phase::erase_last:
      return command(33, address(last_));
    case Phase::erase_all:
      return command(38, 0);
    case Phase::idle:
      return;
  }
}

template <CardSpi Bus>
void SdCard<Bus>::completed(std::uint32_t now_us) {
  switch (phase_) {
    case Phase::clocks:
      return go(Phase::go_idle, now_us);
    case Phase::csd_data:
    case Phase::read_data:
      for (std::size_t i = 0; i < length_; ++i) reader_.add(bytes_[i]);
      return data_came(now_us);
    case Phase::write_data:
      return block_sent(now_us);
    case Phase::write_busy: {
      const bool whole = request_ == Request::write;
      polled(now_us, kWrite_us, Phase::idle);
      if (whole && phase_ == Phase::idle) done(now_us);
      return;
    }
    case Phase::stop:
      return go(Phase::stop_busy, now_us);
    case Phase::stop_busy:
      return polled(now_us, kWrite_us, Phase::status);
    case Phase::erase_busy:
      return polled(now_us, kErase_us, Phase::verify);
    case Phase::absent:
    case Phase::idle:
      return;
    default: {
      const sd::Answer answer =
          sd::find_answer(std::span<const std::uint8_t>(bytes_).first(length_));
      if (phase_ < Phase::idle) return start_command(answer, now_us);
      return transfer_command(answer, now_us);
    }
  }
}

// ---- Start-up

template <CardSpi Bus>
void SdCard<Bus>::start_command(const sd::Answer& answer, std::uint32_t now_us) {
  const bool idle = answer.r1 == 0x01, accepted = answer.r1 == 0x00;
  switch (phase_) {
    case Phase::go_idle:
      if (idle) {
        attempts_ = 0;
        return go(Phase::interface, now_us);
      }
      return ++attempts_ % 8 != 0 ? go(Phase::clocks, now_us) : fail(Status::no_answer, now_us);
    case Phase::interface:
      version_2_ = idle && answer.after[2] == 0x01 && answer.after[3] == 0xAA;
      if (!version_2_ && answer.r1 != 0x05) return fail(Status::bad_data, now_us);
      return go(Phase::crc_on, now_us);
    case Phase::crc_on:
      start_us_ = now_us;
      return idle ? go(Phase::application, now_us) : fail(Status::bad_data, now_us);
    case Phase::application:
      return idle ? go(Phase::operating, now_us) : fail(Status::wrong_id, now_us);
    case Phase::operating:
      if (accepted) return go(Phase::capacity, now_us);
      if (!idle || now_us - start_us_ > kStart_us) return fail(Status::no_answer, now_us);
      return go(Phase::application, now_us);
    case Phase::capacity:
      if (!accepted) return fail(Status::bad_data, now_us);
      high_capacity_ = (answer.after[0] & 0x40) != 0;
      return go(high_capacity_ ? Phase::csd : Phase::block_length, now_us);
    case Phase::block_length:
      return accepted ? go(Phase::csd, now_us) : fail(Status::bad_data, now_us);
    default:  // csd
      if (!accepted) return fail(Status::bad_data, now_us);
      reader_.begin(csd_.data(), csd_.size());
      for (const std::uint8_t byte : answer.rest) reader_.add(byte);
      return go(Phase::csd_data, now_us);
  }
}

// ---- Requests on the wire

template <CardSpi Bus>
void SdCard<Bus>::transfer_command(const sd::Answer& answer, std::uint32_t now_us) {
  if (answer.r1 != 0x00) {
    return fail(answer.r1 == 0xFF ? Status::no_answer : Status::bad_data, now_us);
  }
  switch (phase_) {
    case Phase::read_command:
      reader_.begin(into_, kBlock_bytes);
      for (const std::uint8_t byte : answer.rest) reader_.add(byte);
      return go(Phase::read_data, now_us);
    case Phase::write_command:
      streaming_ = true;
      next_block_ = block_;
      return go(Phase::write_data, now_us);
    case Phase::erase_first:
      return go(Phase::erase_last, now_us);
    case Phase::erase_last:
      return go(Phase::erase_all, now_us);
    case Phase::erase_all:
      return go(Phase::erase_busy, now_us);
    default:  // status, verify: the second byte has the errors of what went before
      if (answer.after[0] != 0) return fail(Status::bad_data, now_us);
      if (phase_ == Phase::verify) return done(now_us);
      return go(Phase::idle, now_us);  // a stream was ended for what comes now
  }
}

template <CardSpi Bus>
void SdCard<Bus>::data_came(std::uint32_t now_us) {
  if (reader_.failed()) return fail(Status::bad_data, now_us);
  if (!reader_.whole()) {
    if (late(now_us, kRead_us)) fail(Status::no_answer, now_us);
    return;
  }
  if (phase_ == Phase::read_data) return done(now_us);
  blocks_ = sd::blocks_of(csd_);
  ++starts_;
  go(Phase::idle, now_us);
}

template <CardSpi Bus>
void SdCard<Bus>::block_sent(std::uint32_t now_us) {
  if (const Status s = sd::data_response(bytes_[length_ - 1]); s != Status::ok)
    return fail(s, now_us);
  ++next_block_;
  go(Phase::write_busy, now_us);
}

template <CardSpi Bus>
void SdCard<Bus>::polled(std::uint32_t now_us, std::uint32_t limit_us, Phase then) {
  if (bytes_[length_ - 1] == 0xFF) {
    if (phase_ == Phase::stop_busy) streaming_ = false;
    return go(then, now_us);
  }
  if (late(now_us, limit_us)) fail(Status::no_answer, now_us);
}

template <CardSpi Bus>
void SdCard<Bus>::fail(Status why, std::uint32_t now_us) {
  if (request_ != Request::none || ready()) ++failures_;
  request_ = Request::none;
  result_ = why;
  streaming_ = false;
  bus_.select(false);
  go(Phase::absent, now_us);
}

}  // namespace fw
