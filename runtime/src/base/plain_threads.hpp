// SPDX-License-Identifier: BSD-3-Clause
//
// Defines TEGL_PLAIN_THREADS for builds with the thread sanitizer. It does not see the synchronisation of the installed
// TBB, which is not built for it. With the sanitizer, plain threads do the same work in the same parts.
#pragma once

#ifdef __SANITIZE_THREAD__
#define TEGL_PLAIN_THREADS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TEGL_PLAIN_THREADS
#endif
#endif
