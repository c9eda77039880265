# SPDX-License-Identifier: BSD-3-Clause
"""Masks of label images, and the level of masks."""

from __future__ import annotations

import dataclasses

import numpy as np

from . import _arguments


def mask_of(array, label: float):
    """1 where `array` has the value `label`, 0 elsewhere, with the array's coordinates. Missing samples stay missing."""
    label = _arguments.as_number("label", label)
    if hasattr(array, "__tegl_image__"):
        return dataclasses.replace(array, array=mask_of(array.array, label))
    if _arguments.is_xarray(array):
        mask = (array == label).astype(np.uint8)
        return mask.where(array.notnull()) if array.dtype.kind == "f" else mask
    values = np.asarray(array) if _arguments.mask_of(array) is None else np.ma.array(array)
    mask = (values == label).astype(np.uint8)
    if values.dtype.kind == "f" and np.isnan(values).any():
        mask = np.ma.where(np.isnan(values), np.float32(np.nan), mask.astype(np.float32))
        mask = mask if isinstance(values, np.ma.MaskedArray) else mask.data
    if not np.any(np.asarray(mask) == 1):
        raise ValueError(f"label is {label:g}; expected a value that a sample has")
    return mask


def middle_of(array: np.ndarray) -> float:
    """The middle of the two values of a mask."""
    values = array.ravel(order="K")
    values = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    if values.size:
        low, high = float(values.min()), float(values.max())
        if low < high and bool(((values == low) | (values == high)).all()):
            return low + (high - low) / 2
    raise ValueError("level is missing, and the array has not exactly two values; expected a level, or label= for the samples "
                     "of one value")
