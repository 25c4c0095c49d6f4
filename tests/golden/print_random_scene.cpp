// Prints a random scene as a scene file: print_random_scene NUMBER. Mesh files are named relative to `scenes`.
#include <cstdio>
#include <cstdlib>

#include "golden/random_scene.h"

int main(int count, char** arguments) {
    if (count != 2) {
        std::fputs("usage: print_random_scene NUMBER\n", stderr);
        return 2;
    }
    std::puts(ricochet::golden::random_scene(std::atoi(arguments[1])).c_str());
    return 0;
}
