// Against a server of our own that speaks openocd's protocol, and against openocd itself, which has no probe here.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <map>
#include <thread>

#include "base/near.hpp"
#include "io_bridges/openocd/core_probe.hpp"
#include "io_bridges/openocd/pc_samples.hpp"
#include "io_bridges/openocd/server.hpp"

namespace whirl::openocd {
namespace {

using Answers = std::map<std::string, std::string>;

// Answers what a table says; what it does not know it complains of, as Tcl does.
class FakeOpenocd {
 public:
  explicit FakeOpenocd(Answers answers) : answers_(std::move(answers)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof where;
    EXPECT_EQ(::bind(listener_, reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&where), &size);
    port_ = ntohs(where.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeOpenocd() {
    ::shutdown(listener_, SHUT_RDWR);
    ::close(listener_);
    thread_.join();
  }
  std::uint16_t port() const { return port_; }
  const std::vector<std::string>& heard() const { return heard_; }

 private:
  void serve() {
    const int peer = ::accept(listener_, nullptr, nullptr);
    if (peer < 0) return;
    std::string waiting;
    char piece[512];
    for (ssize_t n = 0; (n = ::recv(peer, piece, sizeof piece, 0)) > 0;) {
      waiting.append(piece, static_cast<std::size_t>(n));
      if (waiting.find("{die}") != std::string::npos) break;
      for (std::size_t end; (end = waiting.find('\x1a')) != std::string::npos;
           waiting.erase(0, end + 1)) {
        const std::string reply = answer(waiting.substr(0, end)) + '\x1a';
        // In two pieces, as a network may.
        ::send(peer, reply.data(), 1, MSG_NOSIGNAL);
        ::send(peer, reply.data() + 1, reply.size() - 1, MSG_NOSIGNAL);
      }
    }
    ::close(peer);
  }
  std::string answer(const std::string& line) {
    const auto from = line.find('{') + 1;
    const std::string command = line.substr(from, line.find("} whirl_answer") - from);
    heard_.push_back(command);
    if (command == "version") return "0 Open On-Chip Debugger";
    const auto found = answers_.find(command);
    return found == answers_.end() ? "1 invalid command name \"" + command + "\""
                                   : "0 " + found->second;
  }

  Answers answers_;
  std::vector<std::string> heard_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

TEST(CoreProbe, AFaultsRegistersAndTheFrameOnTheProcessStack) {
  FakeOpenocd fake(Answers{
      {"halt", ""},
      {"resume", ""},
      {"get_reg pc", "pc 0x08000200"},
      {"get_reg lr", "lr 0xfffffffd"},
      {"get_reg sp", "sp 0x20001000"},
      {"get_reg xPSR", "xPSR 0x21000003"},
      {"get_reg psp", "psp 0x20002000"},
      {"read_memory 0xE000ED28 32 5", "0x8200 0x40000000 0x0 0xe000ed34 0x60000004"},
      {"read_memory 0x20002000 32 8", "0x1 0x2 0x3 0x4 0xc 0x8000301 0x8000450 0x1000000"}});
  auto client = TclClient::connect(fake.port());
  ASSERT_TRUE(client) << client.error().message();
  const auto state = CoreProbe(*client.value()).look();
  ASSERT_TRUE(state) << state.error().message();
  EXPECT_EQ(state.value().exception, 3u);
  EXPECT_EQ(state.value().cfsr, 0x8200u);
  EXPECT_EQ(state.value().hfsr, 0x40000000u);
  EXPECT_EQ(state.value().bfar, 0x60000004u);
  EXPECT_EQ(state.value().stacked[6], 0x08000450u);
  EXPECT_EQ(fake.heard().back(), "resume");
}

TEST(CoreProbe, WhatOpenocdCannotIsToldInItsWordsAndTheCoreGoesOn) {
  FakeOpenocd fake(Answers{{"halt", ""}, {"resume", ""}});
  auto client = TclClient::connect(fake.port());
  ASSERT_TRUE(client);
  const auto state = CoreProbe(*client.value()).look();
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().message().find("invalid command name \"get_reg pc\""), std::string::npos);
  EXPECT_EQ(fake.heard().back(), "resume");
  EXPECT_FALSE(CoreProbe(*client.value()).flash("a.elf"));
  EXPECT_EQ(fake.heard().back(), "program {a.elf} verify reset");
}

TEST(CoreProbe, SamplingSetsTheTraceEnableAndReadsThePcsr) {
  FakeOpenocd fake(Answers{{"read_memory 0xE000EDFC 32 1", "0x1"},
                           {"write_memory 0xE000EDFC 32 0x01000001", ""},
                           {"read_memory 0xE000101C 32 1", "0x8000124"}});
  auto client = TclClient::connect(fake.port());
  ASSERT_TRUE(client);
  CoreProbe probe(*client.value());
  ASSERT_TRUE(probe.start_sampling());
  const auto pc = probe.sample_pc();
  ASSERT_TRUE(pc);
  EXPECT_EQ(pc.value(), 0x8000124u);
}

TEST(CoreProbe, AnAnswerThatIsNoNumberIsRefused) {
  for (const char* bad : {"", "word", "0x1 0x2", "0x100000000", "-1z"}) {
    FakeOpenocd fake(Answers{{"read_memory 0xE000101C 32 1", bad}});
    auto client = TclClient::connect(fake.port());
    ASSERT_TRUE(client);
    EXPECT_FALSE(CoreProbe(*client.value()).sample_pc()) << bad;
  }
}

TEST(TclClient, NobodyThereIsSaid) {
  std::uint16_t port = 0;
  {
    const FakeOpenocd gone(Answers{});
    port = gone.port();
  }
  const auto client = TclClient::connect(port);
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().kind, ErrorKind::host);
}

TEST(TclClient, AServerThatEndsInsteadOfAnsweringIsSaid) {
  FakeOpenocd server({});
  const auto client = TclClient::connect(server.port(), 1000);
  ASSERT_TRUE(client.ok()) << client.error().message();
  const auto answer = client.value()->ask("die", 1000);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().kind, ErrorKind::host);
  EXPECT_NE(answer.error().what.find("has ended"), std::string::npos) << answer.error().what;
}

// Wilson's interval as published: 81 of 263 is 0.308, 0.2553 to 0.3662 [Newcombe, Statistics in Medicine 17 (1998), table I].
TEST(BusyShare, HasWilsonsInterval) {
  std::vector<std::uint32_t> pcs(263, 0x08000100);
  std::fill(pcs.begin(), pcs.begin() + 81, 0x08000200u);
  const IdleSpan idle[] = {{0x08000100, 0x08000104}};
  const BusyShare b = busy_share(pcs, idle, 0x08000000, 0x08010000);
  EXPECT_EQ(b.samples, 263u);
  EXPECT_TRUE(near(b.low, 0.2553, printed_to(1e-4)));
  EXPECT_TRUE(near(b.high, 0.3662, printed_to(1e-4)));
}

TEST(BusyShare, OneHundredSleepingSamplesAreNoProofOfZero) {
  const std::vector<std::uint32_t> pcs(100, 0x08000102);
  const IdleSpan idle[] = {{0x08000100, 0x08000104}};
  const BusyShare b = busy_share(pcs, idle, 0x08000000, 0x08010000);
  EXPECT_EQ(b.busy, 0u);
  EXPECT_TRUE(near(b.high, 0.037, stated(5e-4, "z^2 / (n + z^2), rounded")));
}

TEST(BusyShare, WhatIsNoCodeIsCountedApart) {
  const std::uint32_t pcs[] = {0xFFFFFFFF, 0x20000000, 0x08000000};
  const BusyShare b = busy_share(pcs, {}, 0x08000000, 0x08010000);
  EXPECT_EQ(b.unknown, 2u);
  EXPECT_EQ(b.samples, 1u);
  EXPECT_EQ(b.busy, 1u);
}

TEST(WaitsIn, FindsTheInstruction) {
  const std::uint8_t code[] = {0x00, 0xBF, 0x30, 0xBF, 0xFD, 0xE7};  // nop, wfi, b .-2
  const auto spans = waits_in(code, 0x08000100);
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].from, 0x08000102u);
  EXPECT_EQ(spans[0].to, 0x08000106u);
}

TEST(Complaint, EachCauseIsOneLineWithItsCure) {
  const struct {
    const char* said;
    const char* what;
  } all[] = {
      {"Error: unable to find a matching CMSIS-DAP device", "no probe is there"},
      {"Error: open failed", "no probe is there"},
      {"Error: libusb_open() failed with LIBUSB_ERROR_ACCESS", "may not be opened"},
      {"Error: libusb_claim_interface() failed with LIBUSB_ERROR_BUSY", "is busy"},
      {"Error: Can't find interface/nothing.cfg", "a configuration is not there"},
      {"Error: init mode failed (unable to connect to the target)", "no target answers"},
      {"something new", "did not start"},
  };
  for (const auto& one : all) {
    const Error error = complaint_of(one.said);
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    EXPECT_NE(error.message().find(one.what), std::string::npos) << error.message();
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
  }
}

// openocd itself: no probe hangs on a machine that builds.
TEST(Openocd, WithoutAProbeGivesOneClearLine) {
  const auto server = Server::start({.files = {"interface/cmsis-dap.cfg", "target/stm32f4x.cfg"}});
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message().find("no probe is there"), std::string::npos)
      << server.error().message();
}

TEST(Openocd, AConfigurationThatIsNotThereIsNamed) {
  const auto server = Server::start({.files = {"interface/of_nobody.cfg"}});
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message().find("interface/of_nobody.cfg"), std::string::npos)
      << server.error().message();
}

TEST(Openocd, NotInstalledIsSaid) {
  const auto server = Server::start({.program = "openocd-of-nobody"});
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message().find("apt-get install openocd"), std::string::npos);
}

// Its dummy adapter has nobody behind it: the real server answers, knows our commands, and says that there is no core.
TEST(Openocd, ItsOwnServerTakesOurCommands) {
  // Its init finds nobody and gives up; here it may, and the server stays.
  auto server = Server::start({.files = {"interface/dummy.cfg", "target/stm32f4x.cfg"},
                               .commands = {"adapter speed 100", "rename init real_init",
                                            "proc init {} { catch { real_init } }"}});
  ASSERT_TRUE(server) << server.error().message();
  CoreProbe probe(server.value()->client());
  const auto pc = probe.sample_pc();
  ASSERT_FALSE(pc);
  EXPECT_NE(pc.error().message().find("failed to read memory"), std::string::npos)
      << pc.error().message();
  const auto state = probe.look();
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().message().find("openocd: cannot 'halt'"), std::string::npos)
      << state.error().message();
  const auto flashed = probe.flash("/nowhere.elf");
  ASSERT_FALSE(flashed);
  const auto unknown = server.value()->client().ask("of_nobody");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message().find("invalid command name"), std::string::npos);
}

}  // namespace
}  // namespace whirl::openocd
