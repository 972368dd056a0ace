// What sanitizers are to overlook, as a part of every program that they watch. ASAN_OPTIONS and the like add to it. The
// names are visible, since the sanitizers, which are libraries, look for them in the program.

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__  // as g++ says it
#endif
#endif

#ifdef __SANITIZE_ADDRESS__
extern "C" [[gnu::visibility("default")]] const char* __asan_default_options() {
    // OpenImageIO deletes its texture system by an empty base class, which is the library's own fault. LeakSanitizer,
    // where it follows __tls_get_addr, takes thread-local variables that happen to begin 16 bytes into a page for those
    // of an older glibc, reads a size where there is none, and crashes at the end of one run in a hundred; it finds those
    // of this glibc without.
    return "new_delete_type_mismatch=0:intercept_tls_get_addr=0";
}
extern "C" [[gnu::visibility("default")]] const char* __lsan_default_suppressions() {
    // OpenImageIO 2.4: libpng leaves OpenImageIO's read callback by longjmp on a cut PNG, past the destructor of a string
    // that geterror() assigned; the caller is not always found. Whoever else leaks the characters of a string leaks the
    // string, too, which is reported.
    return "leak:ImageInput::geterror\nleak:std::__cxx11::basic_string*::_M_assign\n";
}
#endif

#ifdef __SANITIZE_THREAD__
extern "C" [[gnu::visibility("default")]] const char* __tsan_default_options() {
    // Debian's libraries are not instrumented: what they do to their own memory under their own locks looks like races.
    return "ignore_noninstrumented_modules=1:second_deadlock_stack=1";
}
extern "C" [[gnu::visibility("default")]] const char* __tsan_default_suppressions() {
    // Embree calls it on threads of TBB while it builds, and waits for them in a way that is not seen.
    return "race:count_memory\n";
}
#endif
