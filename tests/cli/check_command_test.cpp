#include <gtest/gtest.h>

#include <string>

#include "cli/run_program.h"
#include "io/sample_scene.h"
