"""Command lines: a wrong word is one line that names the remedy, and status 2."""
import argparse

EXIT_UNUSABLE = 2


class Parser(argparse.ArgumentParser):
    def error(self, message):
        message = message.removeprefix("argument ")
        self.exit(EXIT_UNUSABLE, f"{self.prog}: {message}{'' if 'choose from' in message else f': see {self.prog} --help'}\n")
