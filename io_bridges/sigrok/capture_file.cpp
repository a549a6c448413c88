// Files of captures, through libsigrok's session files and input modules.
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "io_bridges/sigrok/capture.hpp"
#include "io_bridges/sigrok/context.hpp"
#include "io_bridges/sigrok/feed.hpp"

namespace whirl::sigrok {
namespace {

constexpr std::size_t kPiece_B = 1 << 20, kHead_B = 1 << 16;

Error unreadable(const std::string& path, const std::string& what) {
  const std::string said = Context::last_complaint();
  return {ErrorKind::bad_input, path, what + (said.empty() ? "" : ": " + said),
          "a .vcd, or a .sr of sigrok-cli or PulseView"};
}

// "$timescale 1 ns $end": ticks to a second; 0: it does not say.
double ticks_Hz(const std::string& head) {
  const auto at = head.find("$timescale");
  if (at == std::string::npos) return 0.0;
  const char* text = head.c_str() + at + std::string("$timescale").size();
  char* rest = nullptr;
  const double count = std::strtod(text, &rest);
  while (*rest == ' ' || *rest == '\t' || *rest == '\n' || *rest == '\r') ++rest;
  const double unit = *rest == 's'   ? 1.0
                      : *rest == 'm' ? 1e-3
                      : *rest == 'u' ? 1e-6
                      : *rest == 'n' ? 1e-9
                      : *rest == 'p' ? 1e-12
                      : *rest == 'f' ? 1e-15
                                     : 0.0;
  return count > 0.0 && unit > 0.0 ? 1.0 / (count * unit) : 0.0;
}

struct InputCloser {
  void operator()(const sr_input* input) const { sr_input_free(input); }
};
using Input = std::unique_ptr<const sr_input, InputCloser>;

// In the type that this version of libsigrok wants.
void set_option(const sr_input_module* module, const char* id, std::int64_t value,
                GHashTable* into) {
  const sr_option** all = sr_input_options_get(module);
  for (const sr_option** at = all; at != nullptr && *at != nullptr; ++at) {
    if (std::strcmp((*at)->id, id) != 0) continue;
    const GVariantType* type = g_variant_get_type((*at)->def);
    GVariant* typed = g_variant_type_equal(type, G_VARIANT_TYPE_UINT64)
                          ? g_variant_new_uint64(static_cast<std::uint64_t>(value))
                      : g_variant_type_equal(type, G_VARIANT_TYPE_INT64)
                          ? g_variant_new_int64(value)
                      : g_variant_type_equal(type, G_VARIANT_TYPE_UINT32)
                          ? g_variant_new_uint32(static_cast<std::uint32_t>(value))
                          : g_variant_new_int32(static_cast<std::int32_t>(value));
    g_hash_table_insert(into, g_strdup(id), g_variant_ref_sink(typed));
  }
  sr_input_options_free(all);
}

// Of every n-th tick one sample: 1 GHz of samples of seconds would fill any memory.
Result<Input> vcd_input(const std::string& path, const std::string& head, double rate_Hz) {
  const double ticks = ticks_Hz(head);
  if (!(ticks > 0.0)) return unreadable(path, "states no $timescale");
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::floor(ticks / rate_Hz + 1e-6)));
  char id[] = "vcd";
  const sr_input_module* module = sr_input_find(id);
  if (module == nullptr) return unreadable(path, "this libsigrok reads no VCD");
  GHashTable* options = g_hash_table_new_full(g_str_hash, g_str_equal, g_free,
                                              reinterpret_cast<GDestroyNotify>(g_variant_unref));
  set_option(module, "downsample", static_cast<std::int64_t>(every), options);
  set_option(module, "skip", 0,
             options);  // times count from 0, not from the first that stands there
  Input input(sr_input_new(module, options));
  g_hash_table_destroy(options);
  if (!input) return unreadable(path, "cannot be read");
  return input;
}

Result<Input> scanned_input(const std::string& path) {
  const sr_input* found = nullptr;
  if (sr_input_scan_file(path.c_str(), &found) != SR_OK || found == nullptr) {
    return unreadable(path, "is no capture that libsigrok knows");
  }
  return Input(found);
}

Result<Done> read_input(const Input& input, std::ifstream& file, const std::string& path,
                        sr_session* session) {
  bool joined = false;
  GString* buffer = g_string_sized_new(kPiece_B);
  const auto send = [&]() -> bool {
    if (sr_input_send(input.get(), buffer) != SR_OK) return false;
    sr_dev_inst* device = sr_input_dev_inst_get(input.get());
    if (joined || device == nullptr) return true;
    joined = true;
    return sr_session_dev_add(session, device) == SR_OK;
  };
  bool good = true;
  std::vector<char> piece(kPiece_B);
  while (good && file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    g_string_truncate(buffer, 0);
    g_string_append_len(buffer, piece.data(), file.gcount());
    if (file.gcount() > 0) good = send();
  }
  if (good && !joined) {  // a file whose head ends with it
    g_string_truncate(buffer, 0);
    good = send();
  }
  good = good && joined && sr_input_end(input.get()) == SR_OK;
  g_string_free(buffer, TRUE);
  if (!good) return unreadable(path, "cannot be read to its end");
  return Done{};
}

Result<Done> read_session_file(const Context& context, const std::string& path, Feed& feed) {
  sr_session* made = nullptr;
  if (sr_session_load(context.get(), path.c_str(), &made) != SR_OK) {
    return unreadable(path, "is no session of sigrok");
  }
  const Session session(made);
  sr_session_datafeed_callback_add(session.get(), feed_callback, &feed);
  if (sr_session_start(session.get()) != SR_OK || sr_session_run(session.get()) != SR_OK) {
    return unreadable(path, "cannot be read to its end");
  }
  return Done{};
}

Result<Done> read_waveforms(const Context& context, const std::string& path, double vcd_rate_Hz,
                            Feed& feed) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead_B, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  file.clear();
  file.seekg(0);
  const bool is_vcd = head.find("$timescale") != std::string::npos ||
                      head.find("$enddefinitions") != std::string::npos;
  const auto input = is_vcd ? vcd_input(path, head, vcd_rate_Hz) : scanned_input(path);
  if (!input) return input.error();
  sr_session* made = nullptr;
  if (sr_session_new(context.get(), &made) != SR_OK) return unreadable(path, "no session");
  const Session session(made);
  sr_session_datafeed_callback_add(session.get(), feed_callback, &feed);
  return read_input(input.value(), file, path, session.get());
}

}  // namespace

Result<Done> read_capture(const std::string& path, double vcd_rate_Hz, const Renamed& names,
                          copper::EdgeSink& sink) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 2> magic{};
  if (!file || !std::filesystem::is_regular_file(path)) {
    return Error{ErrorKind::bad_input, path, "cannot be opened", ""};
  }
  file.read(magic.data(), magic.size());
  const Context context;
  std::ignore = Context::last_complaint();
  Feed feed{.names = names, .sink = sink};
  const bool zip = magic[0] == 'P' && magic[1] == 'K';  // as sigrok's sessions are
  const auto read = zip ? read_session_file(context, path, feed)
                        : read_waveforms(context, path, vcd_rate_Hz, feed);
  if (!read) return read.error();
  if (feed.error) return Error{ErrorKind::bad_input, path, feed.error->what, ""};
  if (!feed.reader) return Error{ErrorKind::bad_input, path, "holds no samples of logic", ""};
  return Done{};
}

}  // namespace whirl::sigrok
