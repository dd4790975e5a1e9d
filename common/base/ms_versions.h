/** Functions of which the compiler makes two versions: for any processor, and for those with AVX2. Private. */
#ifndef MS_VERSIONS_H
#define MS_VERSIONS_H

/*
 * Before a function whose loops are vector code: which version runs is chosen as the program starts. Both give the same
 * bits, since AVX2 alone has no fused multiply-add and sums are in an order of their own. MS_ONE_VERSION leaves it at
 * one, as do systems and tools that cannot choose.
 */
#if defined(MS_ONE_VERSION)
/* as the build asks */
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) /* gcc's names; clang's are features */
#define MS_ONE_VERSION
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define MS_ONE_VERSION
#endif
#endif
#if defined(__x86_64__) && defined(__linux__) && defined(__has_attribute) && !defined(MS_ONE_VERSION)
#if __has_attribute(target_clones)
#define MS_VERSIONS __attribute__((target_clones("avx2", "default")))
#endif
#endif
#ifndef MS_VERSIONS
#define MS_VERSIONS
#endif

#endif
