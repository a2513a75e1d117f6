# The explorer's page: modules and those of d3 that they use, in one script, and its thread in another.
find_program(LEAPMAP_ESBUILD esbuild)
if(LEAPMAP_EMCC AND LEAPMAP_ESBUILD)
  file(GLOB_RECURSE modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/analysis/page/*.js)
  set(page ${PROJECT_SOURCE_DIR}/analysis/page)
  add_custom_command(OUTPUT leapmap-page.js leapmap-worker.js DEPENDS ${modules} VERBATIM
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${LEAPMAP_ESBUILD} --bundle --format=iife
    --charset=utf8 --log-level=warning --legal-comments=none --minify leapmap-page=${page}/main.js
    leapmap-worker=${page}/solver/worker.js --outdir=${PROJECT_BINARY_DIR}
    COMMENT "Bundling the explorer's page")
  add_custom_target(leapmap-page ALL DEPENDS leapmap-page.js leapmap-worker.js)
elseif(LEAPMAP_EMCC)
  message(STATUS "esbuild is not there: the explorer's page cannot be made")
endif()
