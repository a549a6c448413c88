# What `cmake --install build/host --prefix DIR` and CPack's .deb put where; base/places.hpp finds
# it from the program. The images come from the firmware preset, which builds beside this one.
include(GNUInstallDirs)
install(TARGETS whirl RUNTIME DESTINATION bin)
install(TARGETS whirl_board LIBRARY DESTINATION lib/whirl)
install(DIRECTORY test_plans DESTINATION share/whirl)
install(DIRECTORY plant/data DESTINATION share/whirl/plant)
install(DIRECTORY io_bridges/qemu/data DESTINATION share/whirl/io_bridges/qemu)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/firmware/ DESTINATION share/whirl/images
        FILES_MATCHING PATTERN "*.elf" PATTERN CMakeFiles EXCLUDE
        REGEX "build/firmware/(firmware|images)$" EXCLUDE)
install(FILES README.md LICENSE DESTINATION share/doc/whirl)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME whirl)
set(CPACK_PACKAGE_CONTACT "the Whirlstand maintainers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "hardware-in-the-loop test stand for rotorcraft firmware")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "qemu-system-arm (>= 1:7.2), qemu-system-arm (<< 1:7.3)")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gdb-multiarch")
include(CPack)
