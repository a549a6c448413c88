// SPDX-License-Identifier: GPL-2.0-or-later
//
// Entry of the plug-in: qemu-system-arm ... -plugin whirl_board.so,link=FD,config=FD[,any_qemu=on]
//
//   link      descriptor of the shared memory to the harness (io_bridges/link/channel.hpp)
//   config    descriptor of the board's description, JSON
//   any_qemu  go on with a QEMU that is not on the tested list
//   Errors    reach the harness through the link, in words; the process then ends
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "io_bridges/qemu/plugin/instruments.hpp"
#include "io_bridges/qemu/plugin/machine.hpp"
#include "io_bridges/qemu/plugin/plugin_api.hpp"

extern "C" {
__attribute__((visibility("default"))) int qemu_plugin_version = 1;
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id,
                                                               const void* info, int argc,
                                                               char** argv);
}

namespace whirl::qemu {
namespace {

struct Plugin {
  Api api;
  std::string versions;
  std::unique_ptr<Machine> machine;
  std::unique_ptr<Instruments> instruments;
  Notifier board_exists{};
};
Plugin* plugin = nullptr;  // QEMU's callbacks carry no pointer of ours

struct Options {
  int link = -1, config = -1;
  bool any_qemu = false;
};

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 0; i < argc; ++i) {
    const std::string text = argv[i];
    if (text.rfind("link=", 0) == 0) options.link = std::atoi(text.c_str() + 5);
    if (text.rfind("config=", 0) == 0) options.config = std::atoi(text.c_str() + 7);
    if (text == "any_qemu=on") options.any_qemu = true;
  }
  return options;
}

std::string read_all(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) return "";
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  const ssize_t got = pread(fd, text.data(), text.size(), 0);
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

Result<std::string> check_qemu(const Api& api, const std::vector<std::string>& missing,
                               bool any_version) {
  if (!missing.empty()) {
    std::string names;
    for (const std::string& name : missing) names += " " + name;
    return whirl::Error{ErrorKind::host, "QEMU", "it does not export" + names,
                        std::string("use QEMU ") + tested_versions()};
  }
  const Version version = version_of(api);
  if (!version.tested && !any_version) {
    return whirl::Error{ErrorKind::host, "QEMU",
                        "version " + version.number + " (" + version.package + ") is not tested",
                        std::string("use ") + tested_versions() + ", or --any-qemu to try it"};
  }
  return "qemu\t" + version.number + " (" + version.package + ")\n";
}

[[noreturn]] void refuse(io::Channel& channel, const whirl::Error& error) {
  std::fprintf(stderr, "whirl_board: %s\n", error.message().c_str());
  channel.fail(error);
  _exit(1);
}

[[noreturn]] void refuse_as(ErrorKind kind, const std::string& what) {
  plugin->machine->board().refuse({kind, "virtual board", what, ""});
}

// The end of what QEMU has written: its standard error is a file of the harness.
std::string last_words() {
  struct stat status {};
  if (fstat(STDERR_FILENO, &status) != 0 || !S_ISREG(status.st_mode)) return "";
  constexpr off_t kTail = 8192;
  const off_t size = std::min(status.st_size, kTail);
  std::string text(static_cast<std::size_t>(size), '\0');
  const ssize_t got = pread(STDERR_FILENO, text.data(), text.size(), status.st_size - size);
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

// Who ended this process? The core's lock-up (a fault within HardFault or NMI) is told by the words
// with which QEMU gives up; another process by the signal; all else is a bug in it or in us.
void on_abort(int, siginfo_t* info, void*) {
  std::signal(SIGABRT, SIG_DFL);
  const std::string words = last_words();
  if (words.find("qemu: fatal: Lockup: ") != std::string::npos) {
    plugin->machine->core_stopped(board::StoppedCore::locked_up);
  }
  if (info->si_code == SI_USER && info->si_pid != getpid()) {
    refuse_as(ErrorKind::host, "process " + std::to_string(info->si_pid) + " aborted QEMU");
  }
  refuse_as(ErrorKind::internal, "QEMU aborted; its last words:\n" + words);
}

void on_uncaught() {
  try {
    std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    refuse_as(ErrorKind::host, "out of memory");
  } catch (const std::system_error& error) {
    refuse_as(ErrorKind::host, error.what());
  } catch (const std::exception& exception) {
    refuse_as(ErrorKind::internal, std::string("uncaught exception: ") + exception.what());
  } catch (...) {
    refuse_as(ErrorKind::internal, "uncaught exception");
  }
}

// QEMU cannot tell the time while the core enters or leaves an exception, and gives up when a frame or
// a vector is then found among registers. Machine refuses what it can see coming; this is the rest:
// the process stack, and vectors.
void on_exit() {
  if (last_words().find("Bad icount read") == std::string::npos) return;
  plugin->machine->core_stopped(board::StoppedCore::frame_among_registers);
}

void name_every_end() {
  base::set_check_handler(
      [](const std::string& message) { refuse_as(ErrorKind::internal, message); });
  std::set_terminate(on_uncaught);
  std::atexit(on_exit);
  struct sigaction action {};
  action.sa_sigaction = on_abort;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGABRT, &action, nullptr);
}

int install(qemu_plugin_id_t id, const Options& options) {
  auto link = io::Channel::attach(io::Side::board, options.link);
  if (!link) {
    std::fprintf(stderr, "whirl_board: %s\n", link.error().message().c_str());
    return 1;
  }
  io::Channel channel = std::move(link.value());
  plugin = new Plugin;
  const auto versions = check_qemu(plugin->api, resolve(plugin->api), options.any_qemu);
  if (!versions) refuse(channel, versions.error());
  auto setup = board::read_setup(read_all(options.config));
  if (!setup) refuse(channel, setup.error());
  plugin->versions = versions.value();
  plugin->machine =
      std::make_unique<Machine>(plugin->api, std::move(setup.value()), std::move(channel));
  plugin->board_exists.notify = [](Notifier*, void*) {
    name_every_end();
    const auto built = plugin->machine->build(plugin->versions);
    if (!built) plugin->machine->board().refuse(built.error());
    plugin->instruments = std::make_unique<Instruments>(*plugin->machine);
  };
  plugin->api.qemu_add_machine_init_done_notifier(&plugin->board_exists);
  qemu_plugin_register_vcpu_tb_trans_cb(
      id, [](qemu_plugin_id_t, qemu_plugin_tb* block) { plugin->instruments->translated(block); });
  qemu_plugin_register_flush_cb(id, [](qemu_plugin_id_t) {
    if (plugin->instruments) plugin->instruments->code_thrown_away();
  });
  return 0;
}

}  // namespace
}  // namespace whirl::qemu

int qemu_plugin_install(qemu_plugin_id_t id, const void*, int argc, char** argv) {
  return whirl::qemu::install(id, whirl::qemu::read_options(argc, argv));
}
