"""What a stranger may hand in, by the thousand: no traceback, no hang, no silent change, nothing lost."""
