set(WHIRL_CORE_SOURCES register_file.cpp mpu6000.cpp mpu6000_writes.cpp mpu6000_registers.cpp ms5611.cpp hmc5883l.cpp esc_i2c.cpp)
