"""Enums whose members say for people what their integer means."""

import enum


class Outcome(enum.IntEnum):
    """Base of enums with members `NAME = integer, message`."""

    message: str

    def __new__(cls, code: int, message: str):
        member = int.__new__(cls, code)
        member._value_ = code
        member.message = message
        return member
