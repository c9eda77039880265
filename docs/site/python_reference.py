# SPDX-License-Identifier: BSD-3-Clause
"""placeholder"""
def write(source, output):
    return []
