#include <cstdio>

#include "ricochet/ricochet.h"

int main() {
    const double sum =
        ricochet::ordered_sum(1000, 10, [](std::size_t begin, std::size_t end) { return double(end - begin); });
    std::printf("sum %g\n", sum);
}
