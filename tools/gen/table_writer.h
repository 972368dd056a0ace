// Writes tables as they lie in memory: for the programs that compute them while the project is built, which then takes
// the files in as bytes (src/bsdf/albedo_tables.cpp). As initialisers of 40 MB they took the compiler half a minute.
#pragma once

#include <fstream>
#include <iostream>
#include <type_traits>

namespace etendue {

/// Writes `tables` to the file that the program's only argument names. Returns the exit status.
template <typename Tables>
int write_table_file(int argc, char** argv, const Tables& tables) {
    static_assert(std::is_trivially_copyable_v<Tables>);
    if (argc != 2) {
        std::cerr << "usage: " << argv[0] << " OUTPUT\n";
        return 2;
    }
    std::ofstream out(argv[1], std::ios::binary);
    out.write(reinterpret_cast<const char*>(&tables), sizeof(Tables));
    out.flush();
    if (!out) {
        std::cerr << argv[0] << ": cannot write " << argv[1] << "\n";
        return 1;
    }
    return 0;
}

}  // namespace etendue
