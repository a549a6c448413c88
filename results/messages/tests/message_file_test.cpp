#include "results/messages/message_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/digest.hpp"
#include "base/scratch_folder.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;
using Next = MessageReader::Next;

RunHead head() {
  return {"p\xC3\xBC",
          UINT64_MAX,
          1'000'000,
          {{"height", "m", "m"}, {"armed", "", ""}},
          {{"", {"imu"}, {"led"}, {"fw::task"}}, {"second", {}, {}, {}}}};
}

io::Batch batch_of(int number) {
  io::Batch batch;
  batch.add(io::Kind::uart_received, 2, number, &number, sizeof number);
  const std::vector<std::uint8_t> noise(static_cast<std::size_t>(number % 700),
                                        static_cast<std::uint8_t>(number * 37));
  batch.add(io::Kind::statistics, 0, number, noise.data(),
            static_cast<std::uint32_t>(noise.size()));
  return batch;
}

constexpr int kSteps = 3000;

double height(int step) {
  return step == 5 ? std::nan("") : std::sin(step * 0.01);
}

void write(const std::string& path) {
  MessageWriter out(path, head());
  for (int step = 0; step < kSteps; ++step) {
    const double row[] = {height(step), step < 100 ? 0.0 : 1.0};
    out.add_row(step * 1'000'000LL, row);
    out.add(batch_of(step));
  }
  EXPECT_EQ(out.rows(), 3000u);
  EXPECT_TRUE(out.finish());
}

// How many rows and messages could be read before the end or, with a note of it, the damage.
struct Seen {
  int rows = 0, messages = 0;
  std::string damage = {};
  Digest content = {};
};

Seen read_all(MessageReader& in) {
  Seen seen;
  for (;;) {
    const auto next = in.next();
    if (!next) seen.damage = next.error().what;
    if (!next || next.value() == Next::end) return seen;
    const auto payload = in.message().payload();
    seen.content.add_bytes(payload.data(), payload.size());
    (next.value() == Next::row ? seen.rows : seen.messages) += 1;
  }
}

TEST(MessageFile, GivesBackEveryBit) {
  const ScratchFolder folder;
  write(folder.file("m"));
  auto in = MessageReader::open(folder.file("m"));
  ASSERT_TRUE(in) << in.error().message();
  EXPECT_EQ(in.value().head(), head());
  EXPECT_EQ(in.value().rows(), 3000u);
  for (int step = 0; step < kSteps; ++step) {
    ASSERT_EQ(in.value().next().value(), Next::row);
    EXPECT_EQ(in.value().message().header().t_ns, step * 1'000'000LL);
    const double x = in.value().row()[0];
    EXPECT_TRUE(x == height(step) || (step == 5 && std::isnan(x))) << step;
    EXPECT_EQ(in.value().row()[1], step < 100 ? 0.0 : 1.0);
    const io::Batch batch = batch_of(step);
    for (io::Reader wanted(batch.bytes()); wanted.next();) {
      ASSERT_EQ(in.value().next().value(), Next::message);
      const io::Reader& got = in.value().message();
      EXPECT_EQ(got.header().kind, wanted.header().kind);
      EXPECT_EQ(got.header().t_ns, step);
      EXPECT_TRUE(std::equal(got.payload().begin(), got.payload().end(), wanted.payload().begin(),
                             wanted.payload().end()));
    }
  }
  EXPECT_EQ(in.value().next().value(), Next::end);
  EXPECT_EQ(in.value().next().value(), Next::end);
}

TEST(MessageFile, SlowSignalsTakeLittleRoom) {
  const ScratchFolder folder;
  write(folder.file("m"));
  const std::size_t messages = 3000u * (16 + 4 + 16 + 350), rows = 3000u * (16 + 2 * 8);
  EXPECT_LT(fs::file_size(folder.file("m")), (messages + rows) / 10);
}

// Of a process that was killed: what had been written counts.
TEST(MessageFile, ACutFileEndsWhereItIsCut) {
  const ScratchFolder folder;
  {
    MessageWriter out(folder.file("m"), head());
    for (int step = 0; step < kSteps; ++step) {
      const double row[] = {std::sin(step * 12345.678), std::cos(step * 98765.4321)};
      out.add_row(step, row);
    }
  }
  auto in = MessageReader::open(folder.file("m"));
  ASSERT_TRUE(in);
  EXPECT_FALSE(in.value().rows().has_value());
  const Seen seen = read_all(in.value());
  EXPECT_EQ(seen.damage, "");
  EXPECT_LT(seen.rows, kSteps);
}

// A run that came to its end: what is missing or other is damage, but for bits that no reader looks at.
TEST(MessageFile, EveryByteOfAWholeFileCounts) {
  const ScratchFolder folder;
  std::string content;
  const auto damage = [&folder, &content](auto change) {
    write(folder.file("m"));
    change(folder.file("m"), static_cast<std::streamoff>(fs::file_size(folder.file("m"))));
    auto in = MessageReader::open(folder.file("m"));
    if (!in) return in.error().what;
    const Seen seen = read_all(in.value());
    content = seen.content.hex();
    return seen.damage;
  };
  EXPECT_EQ(damage([](const std::string&, std::streamoff) {}), "");
  const std::string right = content;
  const std::string cut =
      damage([](const std::string& path, std::streamoff size) { fs::resize_file(path, size - 1); });
  EXPECT_TRUE(cut.starts_with("is damaged: 3000 of 3000 rows are there, ")) << cut;
  EXPECT_NE(damage([](const std::string& path, std::streamoff) {
              std::ofstream(path, std::ios::binary | std::ios::app) << 'x';
            }),
            "");
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const std::string flipped = damage([&random](const std::string& path, std::streamoff size) {
      // Behind the head, which is text.
      const auto at = size / 50 + static_cast<std::streamoff>(random() % (size / 50 * 49));
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      file.seekg(at);
      const char byte = static_cast<char>(file.get() ^ (1 << random() % 8));
      file.seekp(at);
      file.put(byte);
    });
    EXPECT_TRUE(flipped != "" || content == right) << i;
  }
}

std::string refusal(const std::string& path) {
  const auto in = MessageReader::open(path);
  EXPECT_FALSE(in);
  return in ? "" : in.error().what;
}

void overwrite(const std::string& path, std::streamoff at, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(at);
  file << bytes;
}

TEST(MessageFile, WhatIsNoneIsRefusedWithTheReason) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder.file("none")), "cannot be opened: No such file or directory");
  std::ofstream(folder.file("short")) << "WHIRL";
  EXPECT_EQ(refusal(folder.file("short")), "is no file of a run's messages");
  write(folder.file("m"));
  overwrite(folder.file("m"), 8, std::string("\x07\0\0\0", 4));
  EXPECT_EQ(refusal(folder.file("m")), "is of version 7 of the format; this whirl reads 1");
  write(folder.file("m"));
  overwrite(folder.file("m"), 12, "\xFF\xFF\xFF\x7F");
  EXPECT_EQ(refusal(folder.file("m")), "is damaged: its head has no end");
  write(folder.file("m"));
  overwrite(folder.file("m"), 32, "[");
  EXPECT_EQ(refusal(folder.file("m")),
            "is no file of a run's messages: its first lines do not say of which run");
}

TEST(MessageFile, DamageIsSaid) {
  const ScratchFolder folder;
  write(folder.file("m"));
  overwrite(folder.file("m"), static_cast<std::streamoff>(fs::file_size(folder.file("m")) / 2),
            std::string(64, '\x5A'));
  auto in = MessageReader::open(folder.file("m"));
  ASSERT_TRUE(in);
  EXPECT_TRUE(read_all(in.value()).damage.starts_with("is damaged")) << read_all(in.value()).damage;

  MessageWriter out(folder.file("board"), head());
  io::Batch batch;
  batch.add(io::Header{0, io::Kind::data_ready, 2, 0, 0}, {});  // a third board
  out.add(batch);
  ASSERT_TRUE(out.finish());
  auto board = MessageReader::open(folder.file("board"));
  ASSERT_TRUE(board);
  EXPECT_EQ(read_all(board.value()).damage, "is damaged: a message of a board that is not there");
}

TEST(MessageFile, WhatCannotBeWrittenIsSaidAndLeavesNothing) {
  const ScratchFolder folder;
  fs::create_directory(folder.file("m"));  // in the way
  MessageWriter out(folder.file("m"), head());
  const auto finished = out.finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().kind, ErrorKind::host);
  EXPECT_EQ(finished.error().what, "cannot be written: Is a directory");
  fs::create_symlink("/dev/full", folder.file("full"));  // what is removed is the link
  MessageWriter full(folder.file("full"), head());
  for (int step = 0; step < kSteps; ++step) full.add(batch_of(step));
  const auto lost = full.finish();
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().what, "cannot be written: No space left on device");
}

}  // namespace
}  // namespace whirl::results
