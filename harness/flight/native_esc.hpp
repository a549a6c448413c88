// A speed controller on the harness's side of the I2C device: what a flight plan flies with until
// the real ESC's control core stands behind the same bytes.
//
//   Loop     1 kHz: filters, protections, then duty, RPM or thrust-by-RPM control
//   Control  v = Ke wd + R i(wd) + Kp (wd - w) + integral; the integral stops where v is limited
//   Limit    v stays within Ke w +- i R: winding current within max_current_A (20 A) when driving,
//            brake_current_A when braking, whatever the set-point; and within 0..bus voltage
//   Protocol arming, watchdog and flags as the ESC protocol says (esc_codec.hpp)
//   Beliefs  its motor and thrust figures are the firmware's, not the plant's: [Bangura2017, ch. 3]
//   Left out power modes (config refuses them), six-step start-up, speed sensing near standstill,
//            noise and offset of the current sensor
#pragma once
#include <cstdint>

#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::flight {

struct EscParams {
  io::EscMode mode = io::EscMode::thrust_by_rpm;
  // Beliefs about motor and propeller.
  double back_emf_Vspradps = 0.01005;
  double resistance_ohm = 0.12, commutation_ohm_s = 8e-5;  // the second per rad/s of the shaft
  double no_load_current_A = 1.0;
  double torque_Nmps2prad2 = 2.3e-7;  // shaft torque over speed squared
  double thrust_linear_Nprpm = -1.4715e-4, thrust_square_Nprpm2 = 1.789e-7;
  // Control.
  double kp_Vspradps = 0.020;
  double ki_Vprad = 0.10;
  double max_current_A = 20.0;
  double brake_current_A = 10.0;
  double current_filter_s = 0.020;
  // Protections.
  double arming_voltage_V = 15.7;
  double low_voltage_V = 12.0;
  double trip_current_A = 30.0;  // winding
  int arming_zeros = 25;
  std::int64_t watchdog_ns = 500'000'000;
};

class NativeEsc {
 public:
  struct Sensed {
    double bus_voltage_V = 0.0;
    double speed_radps = 0.0;
    double bus_current_A = 0.0;   // mean over the last period
    double winding_peak_A = 0.0;  // largest magnitude in the last period
    bool blocked = false;
  };
  struct Drive {
    double duty = 0.0;
    bool braking = false;  // the low side may conduct: current may reverse
  };

  explicit NativeEsc(const EscParams& params);

  // A set-point write that has reached the ESC. Rejected ones change nothing.
  void write(std::uint16_t v, bool valid, std::int64_t t_ns);
  Drive step(std::int64_t t_ns, const Sensed& sensed);
  void cut();  // a fault injected into the ESC: it stops and stays so

  io::EscStatus status() const;
  bool armed() const { return armed_; }
  double wanted_speed_radps() const { return wanted_speed_radps_; }

 private:
  enum class Trouble : std::uint8_t { none, over_current, desync, cut };

  void filter(const Sensed& sensed);
  void protect(std::int64_t t_ns, const Sensed& sensed);
  void disarm();
  Drive drive(const Sensed& sensed);
  double ohm(double speed_radps) const {  // of a running winding
    return params_.resistance_ohm + params_.commutation_ohm_s * speed_radps;
  }
  double control_voltage(const Sensed& sensed);
  double limited(double voltage, const Sensed& sensed);
  double speed_for_thrust(double thrust_N) const;

  EscParams params_;
  std::uint16_t v_ = 0;
  int zeros_ = 0;
  bool armed_ = false;
  Trouble trouble_ = Trouble::none;
  std::int64_t last_valid_ns_ = 0;
  double speed_radps_ = 0.0;  // filtered
  double current_A_ = 0.0;    // filtered, bus
  double bus_voltage_V_ = 0.0;
  double integral_V_ = 0.0;
  double wanted_speed_radps_ = 0.0;
  bool saturated_ = false;
  bool low_voltage_ = false;
};

}  // namespace whirl::flight
