#include "io_bridges/protocols/dronecan/assembler.hpp"

#include <algorithm>

namespace whirl::io::dronecan {
namespace {

constexpr std::int64_t kTime_out_ns = 2'000'000'000;
constexpr std::size_t kMost_sessions = 256;

std::uint64_t key_of(const Header& h) {
  return static_cast<std::uint64_t>(h.kind) << 32 | static_cast<std::uint64_t>(h.type_id) << 16 |
         static_cast<std::uint64_t>(h.destination) << 8 | h.source;
}

}  // namespace

const Transfer* Assembler::take(const CanFrame& frame, std::int64_t now_ns) {
  ++counts_.frames;
  auto header = parse_can_id(frame.id);
  if (!frame.extended || frame.remote || !header) return ++counts_.not_dronecan, nullptr;
  if (frame.length == 0 || frame.length > 8) return ++counts_.empty_frame, nullptr;
  if (!meant_for_us(*header)) return nullptr;
  const DataType* type = types_(header->kind, header->type_id);
  if (type == nullptr) return ++counts_.unknown_type, nullptr;

  const std::uint8_t tail = frame.data[frame.length - 1u];
  header->transfer_id = tail & tail::kTransfer_id;
  if (header->source == 0) return take_anonymous(*header, frame, now_ns);

  Session& session = session_of(*header, now_ns);
  session.used_ns = now_ns;
  const bool start = (tail & tail::kStart) != 0, end = (tail & tail::kEnd) != 0;
  if (start ? !begin(session, *header, frame, now_ns) : !goes_on(session, tail, now_ns))
    return nullptr;
  if (!end && frame.length < 8) return drop(session, counts_.short_frame), nullptr;
  if (!add(session, *type, frame.bytes().first(frame.length - 1u))) return nullptr;
  session.toggle = !session.toggle;
  if (!end) return nullptr;
  return finish(session, *header, *type, !start, now_ns);
}

bool Assembler::meant_for_us(const Header& header) {
  if (own_id_ != 0 && header.source == own_id_) return ++counts_.own_id, false;
  if (header.kind == Kind::message || own_id_ == 0) return true;
  if (header.destination != own_id_) return ++counts_.not_for_us, false;
  return true;
}

Assembler::Session& Assembler::session_of(const Header& header, std::int64_t now_ns) {
  const std::uint64_t key = key_of(header);
  const auto found =
      std::find_if(sessions_.begin(), sessions_.end(), [&](const Key& k) { return k.key == key; });
  if (found != sessions_.end()) return *found->session;
  if (sessions_.size() < kMost_sessions) {
    sessions_.push_back({key, std::make_unique<Session>()});
    return *sessions_.back().session;
  }
  const auto oldest = std::min_element(
      sessions_.begin(), sessions_.end(),
      [](const Key& a, const Key& b) { return a.session->used_ns < b.session->used_ns; });
  if (oldest->session->under_way) {
    const bool late = now_ns - oldest->session->first_ns > kTime_out_ns;
    ++(late ? counts_.timed_out : counts_.crowded_out);
  }
  oldest->key = key;
  oldest->session->under_way = oldest->session->any_done = false;
  return *oldest->session;
}

void Assembler::drop(Session& session, std::uint64_t& cause) {
  ++cause;
  session.under_way = false;
}

bool Assembler::begin(Session& session, const Header& header, const CanFrame& frame,
                      std::int64_t now_ns) {
  const auto bytes = frame.bytes().first(frame.length - 1u);
  if ((frame.bytes().back() & tail::kToggle) != 0) return ++counts_.bad_start, false;
  if (session.under_way) {
    const bool late = now_ns - session.first_ns > kTime_out_ns;
    const bool again = !late && session.transfer_id == header.transfer_id &&
                       session.size == bytes.size() &&
                       std::equal(bytes.begin(), bytes.end(), session.data.begin());
    if (again) return ++counts_.repeated, false;  // the first frame, delivered twice
    drop(session, late ? counts_.timed_out : counts_.unfinished);
  }
  if (session.any_done && session.done_id == header.transfer_id &&
      now_ns - session.done_ns <= kTime_out_ns) {
    return ++counts_.repeated, false;
  }
  session.under_way = true;
  session.first_ns = now_ns;
  session.transfer_id = header.transfer_id;
  session.toggle = false;
  session.size = 0;
  return true;
}

bool Assembler::goes_on(Session& session, std::uint8_t tail, std::int64_t now_ns) {
  if (!session.under_way) return ++counts_.missed_start, false;
  if (now_ns - session.first_ns > kTime_out_ns) return drop(session, counts_.timed_out), false;
  if ((tail & tail::kTransfer_id) != session.transfer_id) {
    return ++counts_.wrong_transfer_id, false;
  }
  if (((tail & tail::kToggle) != 0) != session.toggle) return ++counts_.wrong_toggle, false;
  return true;
}

bool Assembler::add(Session& session, const DataType& type, std::span<const std::uint8_t> bytes) {
  if (session.size + bytes.size() > std::min<std::size_t>(type.most_bytes, kMost_payload) + 2) {
    return drop(session, counts_.too_long), false;
  }
  std::copy(bytes.begin(), bytes.end(),
            session.data.begin() + static_cast<std::ptrdiff_t>(session.size));
  session.size += bytes.size();
  return true;
}

const Transfer* Assembler::finish(Session& session, const Header& header, const DataType& type,
                                  bool many, std::int64_t now_ns) {
  auto payload = std::span<const std::uint8_t>(session.data).first(session.size);
  if (many) {
    if (session.size < 2) return drop(session, counts_.bad_crc), nullptr;
    const unsigned crc = payload[0] | static_cast<unsigned>(payload[1]) << 8;
    payload = payload.subspan(2);
    if (crc != transfer_crc(type.signature, payload)) {
      return drop(session, counts_.bad_crc), nullptr;
    }
  } else if (payload.size() > type.most_bytes) {
    return drop(session, counts_.too_long), nullptr;
  }
  session.under_way = false;
  session.any_done = true;
  session.done_id = header.transfer_id;
  session.done_ns = now_ns;
  ++counts_.transfers;
  done_ = {header, session.first_ns, now_ns, payload};
  return &done_;
}

const Transfer* Assembler::take_anonymous(const Header& header, const CanFrame& frame,
                                          std::int64_t now_ns) {
  const std::uint8_t flags = frame.data[frame.length - 1u] & ~tail::kTransfer_id;
  if (flags != (tail::kStart | tail::kEnd)) return ++counts_.bad_anonymous, nullptr;
  anonymous_ = frame.data;
  ++counts_.transfers;
  done_ = {header, now_ns, now_ns, std::span(anonymous_).first(frame.length - 1u)};
  return &done_;
}

}  // namespace whirl::io::dronecan
