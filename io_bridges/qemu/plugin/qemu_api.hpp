// SPDX-License-Identifier: GPL-2.0-or-later
//
// The functions of QEMU that the virtual board calls, found by name in the running process.
//
//   Why      Debian's qemu-system-arm exports its symbols; these take pointers and numbers only, so
//            no header of QEMU is needed. Structures that QEMU fills in are opaque and over-sized.
//   Checked  each name at load; the version against a list of tested ones
//   Source   QEMU 7.2: include/exec/memory.h, include/qemu/timer.h, include/hw/core/cpu.h,
//            include/sysemu/{cpus,runstate,reset}.h, softmmu/icount.c
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace whirl::qemu {

using hwaddr = std::uint64_t;
struct Object;  // QOM
struct Irq;     // struct IRQState
struct Cpu;     // CPUState
struct AddressSpace;
struct AioContext;
struct Error;

struct alignas(16) MemoryRegion {
  char opaque[1024];  // 7.2 on 64-bit hosts: below 300 bytes
};
struct alignas(16) Timer {
  char opaque[256];
};
// GSource of GLib 2 (gmain.h), as far as it is public.
struct GlibSource;
struct GlibSourceFunctions {
  int (*prepare)(GlibSource*, int* timeout);
  int (*check)(GlibSource*);
};
struct GlibSource {
  void* callback_data;
  void* callback_functions;
  const GlibSourceFunctions* functions;
};
struct Attributes {  // MemTxAttrs, a 32-bit bit field; 0: privileged, non-secure
  std::uint32_t bits;
};
constexpr Attributes kPrivileged{0};
constexpr std::uint32_t kOk = 0, kBusError = 1, kNobody = 2;  // MemTxResult

struct RegionOps {
  std::uint64_t (*read)(void*, hwaddr, unsigned size);
  void (*write)(void*, hwaddr, std::uint64_t value, unsigned size);
  std::uint32_t (*read_with_attrs)(void*, hwaddr, std::uint64_t* value, unsigned size, Attributes);
  std::uint32_t (*write_with_attrs)(void*, hwaddr, std::uint64_t value, unsigned size, Attributes);
  int endianness;
  struct {
    unsigned minimum, maximum;
    bool unaligned;
    bool (*accepts)(void*, hwaddr, unsigned size, bool is_write, Attributes);
  } valid;
  struct {
    unsigned minimum, maximum;
    bool unaligned;
  } implementation;
};
constexpr int kLittleEndian = 2;

struct Notifier {
  void (*notify)(Notifier*, void*);
  void* link[2];
};
union WorkData {
  int number;
  void* pointer;
  std::uint64_t word;
};
struct GByteArray {  // glib's, public layout
  std::uint8_t* data;
  unsigned length;
};
struct VersionTriple {
  std::int64_t major, minor, micro;
};
struct VersionInfo {
  VersionTriple* qemu;
  char* package;
};

constexpr int kVirtualClock = 1;  // QEMU_CLOCK_VIRTUAL
constexpr int kGuestReset = 7;    // SHUTDOWN_CAUSE_GUEST_RESET
constexpr unsigned kWord = 2;     // MO_32, little endian

// One line per function: name, result, parameters.
#define WHIRL_QEMU_FUNCTIONS(F)                                                                    \
  F(get_system_memory, MemoryRegion*, (void))                                                      \
  F(memory_region_init_io, void,                                                                   \
    (MemoryRegion*, Object*, const RegionOps*, void*, const char*, std::uint64_t))                 \
  F(memory_region_init_rom_device_nomigrate, void,                                                 \
    (MemoryRegion*, Object*, const RegionOps*, void*, const char*, std::uint64_t, Error**))        \
  F(memory_region_init_ram_ptr, void, (MemoryRegion*, Object*, const char*, std::uint64_t, void*)) \
  F(memory_region_init_alias, void,                                                                \
    (MemoryRegion*, Object*, const char*, MemoryRegion*, hwaddr, std::uint64_t))                   \
  F(memory_region_add_subregion_overlap, void, (MemoryRegion*, hwaddr, MemoryRegion*, int))        \
  F(memory_region_dispatch_read, std::uint32_t,                                                    \
    (MemoryRegion*, hwaddr, std::uint64_t*, unsigned, Attributes))                                 \
  F(memory_region_dispatch_write, std::uint32_t,                                                   \
    (MemoryRegion*, hwaddr, std::uint64_t, unsigned, Attributes))                                  \
  F(address_space_rw, std::uint32_t, (AddressSpace*, hwaddr, Attributes, void*, hwaddr, bool))     \
  F(address_space_write_rom, std::uint32_t,                                                        \
    (AddressSpace*, hwaddr, Attributes, const void*, hwaddr))                                      \
  F(cpu_get_address_space, AddressSpace*, (Cpu*, int))                                             \
  F(object_resolve_path_type, Object*, (const char*, const char*, bool*))                          \
  F(object_resolve_path_component, Object*, (Object*, const char*))                                \
  F(qdev_get_gpio_in, Irq*, (Object*, int))                                                        \
  F(qemu_set_irq, void, (Irq*, int))                                                               \
  F(object_get_class, void*, (void*))                                                              \
  F(object_class_dynamic_cast, void*, (void*, const char*))                                        \
  F(arm_v7m_cpu_do_interrupt, void, (Cpu*))                                                        \
  F(armv7m_nvic_set_pending, void, (void*, int, bool))                                             \
  F(qemu_clock_get_ns, std::int64_t, (int))                                                        \
  F(qemu_clock_run_timers, bool, (int))                                                            \
  F(timer_init_full, void, (Timer*, void*, int, int, int, void (*)(void*), void*))                 \
  F(timer_mod, void, (Timer*, std::int64_t))                                                       \
  F(timer_del, void, (Timer*))                                                                     \
  F(qemu_add_machine_init_done_notifier, void, (Notifier*))                                        \
  F(qemu_get_cpu, Cpu*, (int))                                                                     \
  F(async_run_on_cpu, void, (Cpu*, void (*)(Cpu*, WorkData), WorkData))                            \
  F(cpu_thread_is_idle, bool, (Cpu*))                                                              \
  F(cpu_exit, void, (Cpu*))                                                                        \
  F(icount_start_warp_timer, void, (void))                                                         \
  F(runstate_is_running, bool, (void))                                                             \
  F(qemu_bh_new_full, void*, (void (*)(void*), void*, const char*, void* no_guard))                \
  F(qemu_bh_schedule, void, (void*))                                                               \
  F(qemu_get_aio_context, AioContext*, (void))                                                     \
  F(iohandler_get_aio_context, AioContext*, (void))                                                \
  F(aio_get_g_source, GlibSource*, (AioContext*))                                                  \
  F(qemu_devices_reset, void, (int))                                                               \
  F(qemu_mutex_lock_iothread_impl, void, (const char*, int))                                       \
  F(qemu_mutex_unlock_iothread, void, (void))                                                      \
  F(qemu_mutex_iothread_locked, bool, (void))                                                      \
  F(arm_cpu_gdb_read_register, int, (Cpu*, GByteArray*, int))                                      \
  F(arm_cpu_gdb_write_register, int, (Cpu*, std::uint8_t*, int))                                   \
  F(object_get_typename, const char*, (const void*))                                               \
  F(object_type_get_instance_size, std::size_t, (const char*))                                     \
  F(tb_flush, void, (Cpu*))                                                                        \
  F(tcg_code_size, std::size_t, (void))                                                            \
  F(tcg_code_capacity, std::size_t, (void))                                                        \
  F(tb_invalidate_phys_addr, void, (AddressSpace*, hwaddr, Attributes))                            \
  F(curr_cflags, std::uint32_t, (Cpu*))                                                            \
  F(cpu_loop_exit_noexc, void, (Cpu*))                                                             \
  F(qmp_query_version, VersionInfo*, (Error**))                                                    \
  F(g_byte_array_new, GByteArray*, (void))                                                         \
  F(g_byte_array_set_size, GByteArray*, (GByteArray*, unsigned))

struct Api {
// NOLINTNEXTLINE(bugprone-macro-parentheses): types and parameter lists
#define WHIRL_DECLARE(name, result, parameters) result(*name) parameters = nullptr;
  WHIRL_QEMU_FUNCTIONS(WHIRL_DECLARE)
#undef WHIRL_DECLARE
  AddressSpace* address_space_memory = nullptr;
};

// Fills `api`; returns the names that this QEMU does not have.
std::vector<std::string> resolve(Api& api);

struct Version {
  std::string number;   // "7.2.22"
  std::string package;  // "Debian 1:7.2+dfsg-7+deb12u18+b3"
  bool tested = false;
};
Version version_of(const Api& api);
const char* tested_versions();  // for messages

}  // namespace whirl::qemu
