// Writes nested arrays of numbers as C++ initialisers: for the programs that compute tables while the project is built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <ostream>

namespace etendue {

inline void write_value(std::ostream& out, float value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.8ff", static_cast<double>(value));
    out << text.data();
}

inline void write_value(std::ostream& out, std::uint16_t value) {
    out << value;
}

template <typename T, std::size_t N>
void write_value(std::ostream& out, const std::array<T, N>& values) {
    out << "{{";
    for (std::size_t i = 0; i < N; ++i) {
        if (i > 0) out << (i % 8 == 0 ? ",\n" : ",");
        write_value(out, values[i]);
    }
    out << "}}";
}

/// `const TYPE NAME = {{...}};`
template <typename T>
void write_table(std::ostream& out, const char* type, const char* name, const T& values) {
    out << "const " << type << " " << name << " = ";
    write_value(out, values);
    out << ";\n";
}

/// The whole of such a program: `write(out)` fills the file that its only argument names. Returns the exit status.
template <typename Write>
int write_table_file(int argc, char** argv, const char* program, const Write& write) {
    if (argc != 2) {
        std::cerr << "usage: " << program << " OUTPUT.inc\n";
        return 2;
    }
    std::ofstream out(argv[1]);
    write(out);
    out.flush();
    if (!out) {
        std::cerr << program << ": cannot write " << argv[1] << "\n";
        return 1;
    }
    return 0;
}

}  // namespace etendue
