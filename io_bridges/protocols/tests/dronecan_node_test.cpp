// Node ids that are given out, nodes that restart, two nodes of one id.
#include <gtest/gtest.h>

#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/protocols/dronecan/node_watch.hpp"

namespace whirl::io::dronecan {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

UniqueId unique(std::uint8_t seed) {
  UniqueId id{};
  for (std::size_t n = 0; n < id.size(); ++n) id[n] = static_cast<std::uint8_t>(seed + n);
  return id;
}

Allocation part(const UniqueId& id, std::size_t from, std::size_t count, std::uint8_t wanted = 0) {
  Allocation request{.node_id = wanted, .first_part = from == 0};
  for (std::size_t n = from; n < from + count; ++n) request.unique_id.add(id[n]);
  return request;
}

// The three requests of a node, as the protocol orders them. 0: it got no id.
std::uint8_t ask(Allocator& allocator, const UniqueId& id, std::int64_t now_ns,
                 std::uint8_t wanted = 0) {
  const auto first = allocator.on_request(part(id, 0, 6, wanted), now_ns);
  EXPECT_TRUE(first && first->unique_id.size == 6 && first->node_id == 0);
  const auto second = allocator.on_request(part(id, 6, 6, wanted), now_ns + 100 * kMillisecond);
  EXPECT_TRUE(second && second->unique_id.size == 12);
  const auto third = allocator.on_request(part(id, 12, 4, wanted), now_ns + 200 * kMillisecond);
  if (!third) return 0;
  EXPECT_EQ(third->unique_id.items, id);
  return third->node_id;
}

TEST(DronecanAllocator, GivesFrom125DownwardsAndTheSameAgain) {
  Allocator allocator;
  EXPECT_EQ(ask(allocator, unique(1), 0), 125);
  EXPECT_EQ(ask(allocator, unique(2), kSecond), 124);
  EXPECT_EQ(ask(allocator, unique(1), 2 * kSecond), 125);  // it has restarted
  EXPECT_EQ(ask(allocator, unique(3), 3 * kSecond, 20), 20);
  EXPECT_EQ(ask(allocator, unique(4), 4 * kSecond, 20), 19);
}

TEST(DronecanAllocator, LeavesOutWhatIsInUseAndEndsWhenAllAre) {
  Allocator allocator;
  allocator.occupied(125);
  EXPECT_EQ(ask(allocator, unique(1), 0), 124);
  for (std::uint8_t id = 1; id <= 123; ++id) allocator.occupied(id);
  EXPECT_EQ(ask(allocator, unique(2), kSecond), 0);
  EXPECT_EQ(allocator.counts().full, 1u);
}

TEST(DronecanAllocator, APartThatComesTooLateOrOutOfTurnBeginsNothing) {
  Allocator allocator;
  EXPECT_FALSE(allocator.on_request(part(unique(1), 6, 6), 0));
  EXPECT_TRUE(allocator.on_request(part(unique(1), 0, 6), 0));
  EXPECT_FALSE(allocator.on_request(part(unique(1), 6, 6), 501 * kMillisecond));
  EXPECT_FALSE(allocator.on_request(part(unique(1), 0, 5), 600 * kMillisecond));
  EXPECT_EQ(allocator.counts().timed_out, 1u);
  EXPECT_EQ(allocator.counts().out_of_turn, 3u);
  EXPECT_EQ(ask(allocator, unique(1), kSecond), 125);
}

NodeStatus at(std::uint32_t uptime_s) {
  return {.uptime_s = uptime_s};
}

TEST(DronecanNodeWatch, TellsARestart) {
  NodeWatch watch;
  EXPECT_EQ(watch.on_status(20, at(100), 0), NodeEvent::appeared);
  EXPECT_EQ(watch.on_status(20, at(101), kSecond), std::nullopt);
  EXPECT_EQ(watch.on_status(20, at(0), 2 * kSecond), NodeEvent::restarted);
  for (std::uint32_t s = 1; s < 200; ++s) {
    EXPECT_EQ(watch.on_status(20, at(s), (2 + s) * kSecond), std::nullopt) << s;
  }
  EXPECT_EQ(watch.node(20).restarts, 1u);
  EXPECT_FALSE(watch.node(20).two_of_one_id);
}

TEST(DronecanNodeWatch, TellsTwoNodesOfOneIdFromARestart) {
  NodeWatch watch;
  watch.on_status(20, at(100), 0);
  EXPECT_EQ(watch.on_status(20, at(7), kSecond / 2), NodeEvent::restarted);  // as it seems so far
  EXPECT_EQ(watch.on_status(20, at(101), kSecond), NodeEvent::two_of_one_id);
  EXPECT_EQ(watch.on_status(20, at(8), 3 * kSecond / 2), std::nullopt);
  EXPECT_TRUE(watch.node(20).two_of_one_id);
}

TEST(DronecanAllocator, KeepsToItsRangeButForIdsThatAreKept) {
  Allocator allocator(100, 101);
  allocator.keep(unique(9), 101);
  allocator.keep(unique(8), 20);
  EXPECT_EQ(ask(allocator, unique(1), 0), 100);
  EXPECT_EQ(ask(allocator, unique(2), kSecond), 0);
  EXPECT_EQ(ask(allocator, unique(9), 2 * kSecond), 101);
  EXPECT_EQ(ask(allocator, unique(8), 3 * kSecond, 100), 20);
}

CanFrame status_frame(std::uint32_t uptime_s, std::uint8_t transfer_id) {
  const Payload payload = encode(at(uptime_s));
  const Header header{.type_id = 341, .source = 20, .transfer_id = transfer_id};
  return frames_of(header, NodeStatus::kType.signature, payload.bytes()).front();
}

// Switched on together, or a second apart: their uptimes say nothing.
TEST(DronecanNodeWatch, TellsTwoNodesOfOneIdThatStartedTogether) {
  for (const int ahead : {0, 1, 2}) {
    NodeWatch watch;
    for (std::uint8_t s = 0; s < 10; ++s) {
      watch.on_frame(status_frame(s, s), s * kSecond);
      if (s >= ahead) {
        watch.on_frame(status_frame(s - ahead, s - ahead), s * kSecond + 400 * kMillisecond);
      }
    }
    EXPECT_TRUE(watch.node(20).two_of_one_id) << ahead;
  }
}

TEST(DronecanNodeWatch, OneNodeIsNotTwoForAFrameDeliveredTwiceNorForLostOnesNorForJumpsOfItsIds) {
  NodeWatch watch;
  std::uint8_t jumping = 0;
  NodeWatch jumps;
  for (std::uint8_t s = 0; s < 100; ++s) {
    if (s % 7 == 3) continue;  // lost
    watch.on_frame(status_frame(s, s & 31), s * kSecond);
    watch.on_frame(status_frame(s, s & 31), s * kSecond + kMillisecond / 5);
    jumping = (jumping + 27) & 31;
    jumps.on_frame(status_frame(s, jumping), s * kSecond);
  }
  EXPECT_FALSE(watch.node(20).two_of_one_id);
  EXPECT_FALSE(jumps.node(20).two_of_one_id);
}

TEST(DronecanNodeWatch, ANodeIsOfflineAfterThreeSeconds) {
  NodeWatch watch;
  EXPECT_FALSE(watch.online(20, 0));
  watch.on_status(20, at(1), 0);
  EXPECT_TRUE(watch.online(20, 3 * kSecond));
  EXPECT_FALSE(watch.online(20, 3 * kSecond + 1));
  EXPECT_EQ(watch.on_status(20, at(11), 10 * kSecond), NodeEvent::back_online);
}

struct Pair {  // two nodes on one wire
  std::vector<CanFrame> from_a, from_b;
  LocalNode a{10, "org.example.a", [this](const CanFrame& frame) { from_a.push_back(frame); }};
  LocalNode b{20, "org.example.b", [this](const CanFrame& frame) { from_b.push_back(frame); }};

  const Transfer* to_b(std::int64_t now_ns) { return give(b, from_a, now_ns); }
  const Transfer* to_a(std::int64_t now_ns) { return give(a, from_b, now_ns); }
  static const Transfer* give(LocalNode& node, std::vector<CanFrame>& frames, std::int64_t now_ns) {
    const Transfer* last = nullptr;
    for (const CanFrame& frame : std::exchange(frames, {})) last = node.on_frame(frame, now_ns);
    return last;
  }
};

TEST(DronecanLocalNode, TellsItsStatusEachSecondAndIsSeen) {
  Pair pair;
  for (std::int64_t t_ns = 0; t_ns < 3 * kSecond; t_ns += kMillisecond) {
    pair.a.poll(t_ns);
    pair.to_b(t_ns);
  }
  EXPECT_EQ(pair.b.counts().transfers, 3u);
  EXPECT_TRUE(pair.b.watch().online(10, 3 * kSecond));
  EXPECT_EQ(pair.b.watch().node(10).status.uptime_s, 2u);
}

TEST(DronecanLocalNode, AnswersWhoItIsToWhomAsks) {
  Pair pair;
  pair.b.poll(0);
  pair.from_b.clear();
  pair.a.request(GetNodeInfoRequest{}, 20);
  EXPECT_EQ(pair.to_b(5 * kSecond), nullptr);
  const Transfer* answer = pair.to_a(5 * kSecond);
  ASSERT_TRUE(answer != nullptr);
  EXPECT_EQ(answer->header.source, 20);
  const auto info = pair.a.read<GetNodeInfoResponse>(*answer);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->name_text(), "org.example.b");
  EXPECT_EQ(info->status.uptime_s, 5u);
  pair.a.request(GetNodeInfoRequest{}, 21);  // somebody else
  pair.to_b(5 * kSecond);
  EXPECT_TRUE(pair.from_b.empty());
}

TEST(DronecanLocalNode, CountsWhatIsWholeButOfNoLayout) {
  Pair pair;
  Payload payload;
  payload.size = 13;  // esc.Status has 14
  const Header header{.type_id = EscStatus::kType.id, .source = 20};
  const Transfer* transfer = nullptr;
  for (const CanFrame& frame : frames_of(header, EscStatus::kType.signature, payload.bytes())) {
    transfer = pair.a.on_frame(frame, 0);
  }
  ASSERT_TRUE(transfer != nullptr);
  EXPECT_FALSE(pair.a.read<EscStatus>(*transfer));
  EXPECT_EQ(pair.a.counts().malformed, 1u);
}

}  // namespace
}  // namespace whirl::io::dronecan
