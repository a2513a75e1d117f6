# What else is installed, and the Debian package: cpack -G DEB --config build/package/CPackConfig.cmake, of
# the preset package
if(EXISTS ${LEAPMAP_PYTHON})
  set(manual ${PROJECT_BINARY_DIR}/leapmap.1.gz ${PROJECT_BINARY_DIR}/leapmap.bash)
  add_custom_command(OUTPUT ${manual} DEPENDS leapmap-program src/cli/manual.py VERBATIM
    COMMAND ${LEAPMAP_PYTHON} ${PROJECT_SOURCE_DIR}/src/cli/manual.py $<TARGET_FILE:leapmap-program>
    ${PROJECT_BINARY_DIR}
    COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/leapmap.1
    COMMENT "Man page and bash completion")
  add_custom_target(leapmap-manual ALL DEPENDS ${manual})
  install(FILES ${PROJECT_BINARY_DIR}/leapmap.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${PROJECT_BINARY_DIR}/leapmap.bash DESTINATION
    ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME leapmap)
endif()
install(DIRECTORY sweeps/ DESTINATION ${CMAKE_INSTALL_DATADIR}/leapmap/sweeps FILES_MATCHING PATTERN "*.toml"
  PATTERN "*.csv")
install(FILES README.md CHANGELOG.md CITATION.cff cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY build/docs/html DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)  # made by docs/build.sh
configure_file(cmake/changelog.in changelog @ONLY)
file(ARCHIVE_CREATE OUTPUT ${PROJECT_BINARY_DIR}/changelog.gz PATHS ${PROJECT_BINARY_DIR}/changelog FORMAT raw
  COMPRESSION GZip)
install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME leapmap)
set(CPACK_PACKAGE_CONTACT "The leapmap authors <leapmap@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "design-space explorer for passive jumping hoops")
set(CPACK_PACKAGE_DESCRIPTION
  "A thin hoop with an off-centre mass rolls down a plane and jumps without a motor. leapmap shows which
designs jump, how high and how soon: a program, a C++ library, a Python module, charts, and a page to explore
maps with.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # what the program and the module are linked to
if(TARGET leapmap-python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy, python3-h5py, \
python3-matplotlib, python3-xarray")
endif()
# to link the library
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "libgsl-dev, libhdf5-dev, libfmt-dev, libdeflate-dev, zlib1g-dev, libudunits2-dev, libpugixml-dev, \
libzip-dev, libnlopt-dev, libflint-arb-dev")
include(CPack)
